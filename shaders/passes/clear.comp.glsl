// Empties the layer of ids: no object anywhere.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, r32ui) writeonly uniform uimage2D id;

void main() { imageStore(id, ivec2(gl_GlobalInvocationID.xy), uvec4(0u)); } // what lies outside is not stored

// Counts box fragments by additive blending, without any depth test.
layout(location = 0) flat in uint entry;
layout(location = 0) out float box_overdraw;

void main() { box_overdraw = 1.0; }

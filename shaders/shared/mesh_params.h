// Rows of the mesh pool, its draws and its materials.
#ifndef BRICKFIELD_MESH_PARAMS_H
#define BRICKFIELD_MESH_PARAMS_H
#include "shared/bridge.h"

SHARED_BEGIN

struct MeshVertex {
  vec4 position; // object space; w: bits of the octahedral normal, SNORM 2x16
  vec4 uv;       // set 0, set 1
  uvec4
      codes; // x: octahedral tangent, SNORM 2x16; y, z: colour, four halves; w: sign of the bitangent, 0 none, 1 +, 2 -
};
SHARED_ASSERT_SIZE(MeshVertex, 48)

struct MeshDraw {
  mat4 worldFromObject;
  ivec4 ids; // x: node; y: material; z: DRAW_* flags
};
SHARED_ASSERT_SIZE(MeshDraw, 80)

// Where a node's meshes were in the frame before.
struct NodeMotion {
  vec4 previousEyeFromEye[3]; // rows of the affine transform of points that move as the node does; both from the eye of
                              // now
  ivec4 isDrawn;              // x: 1 where no such transform is true of all that the node draws
};
SHARED_ASSERT_SIZE(NodeMotion, 64)

// Where a draw was in the frame before.
struct MeshMotion {
  mat4 previousWorldFromObject;
  ivec4 vertices; // x: first of its deformed vertices of then, -1 none; y: its first vertex now; z: its undeformed one
};
SHARED_ASSERT_SIZE(MeshMotion, 80)

SHARED_CONST uint DRAW_FLAT_NORMALS = 1;
SHARED_CONST uint DRAW_MIRRORED = 2;

struct MaterialRow {
  vec4 baseColor;
  vec4 emission; // rgb; w: alpha cutoff, negative where nothing is cut
  vec4 factors;  // metallic, roughness, normal scale, occlusion strength
  ivec4 flags;   // x: 1 unlit; y: 1 double-sided; z: bits of the textures in use; w: bits of those that take UV set 1
  vec4 textureFromUv[10]; // two rows for each texture: (m00 m01 offset), in the order of MATERIAL_*
};
SHARED_ASSERT_SIZE(MaterialRow, 64 + 160)

SHARED_CONST uint MATERIAL_BASE_COLOR = 0;
SHARED_CONST uint MATERIAL_METALLIC_ROUGHNESS = 1;
SHARED_CONST uint MATERIAL_NORMAL = 2;
SHARED_CONST uint MATERIAL_OCCLUSION = 3;
SHARED_CONST uint MATERIAL_EMISSION = 4;
SHARED_CONST uint MATERIAL_TEXTURES = 5;

// One deformed primitive: counts and places in the pools that shaders/passes/deform.comp.glsl reads.
struct DeformParams {
  uvec4 vertices; // x: first source vertex; y: count; z: first result vertex; w: influences a vertex (0, 4, 8)
  uvec4 sources;  // x: first influence; y: first morph row; z: morph targets; w: first joint matrix
  uvec4 weights;  // x: first morph weight
};
SHARED_ASSERT_SIZE(DeformParams, 48)

SHARED_END

#endif

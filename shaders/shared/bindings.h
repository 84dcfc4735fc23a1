// Binding points of buffers, texture units and attributes, the same in every program.
#ifndef BRICKFIELD_BINDINGS_H
#define BRICKFIELD_BINDINGS_H
#include "shared/bridge.h"

SHARED_BEGIN

// Uniform buffers
SHARED_CONST uint kFrameUniformBinding = 0;
SHARED_CONST uint kShadowMapUniformBinding = 2;
// Storage buffers. OpenGL 4.5 promises eight to a stage; no program uses more.
SHARED_CONST uint kMeshDrawBinding = 0;
SHARED_CONST uint kScreenBoxBinding = 0; // where no meshes are drawn
SHARED_CONST uint kWorkListBinding = 0;
SHARED_CONST uint kMaterialBinding = 1;
SHARED_CONST uint kSdfInstanceBinding = 2;
SHARED_CONST uint kSdfLevelBinding = 3;
SHARED_CONST uint kIndirectionBinding = 4;
SHARED_CONST uint kSdfLookBinding = 5; // where no mesh has motion vectors
SHARED_CONST uint kNodeLookBinding = 6;
SHARED_CONST uint kLightBinding = 1;       // of passes that know no materials
SHARED_CONST uint kPassBufferABinding = 6; // what one pass alone uses
SHARED_CONST uint kPassBufferBBinding = 7;
SHARED_CONST uint kMotionVertexBinding = 5; // the mesh pool's vertices, where meshes have motion vectors
SHARED_CONST uint kDeformSourceBinding = 0;
SHARED_CONST uint kDeformResultBinding = 1;
SHARED_CONST uint kDeformInfluenceBinding = 2;
SHARED_CONST uint kDeformMorphBinding = 3;
SHARED_CONST uint kDeformJointBinding = 4;
SHARED_CONST uint kDeformWeightBinding = 5;
// The world field's passes
SHARED_CONST uint kFieldUniformBinding = 1; // uniform buffer
SHARED_CONST uint kFieldListBinding = 0;    // tiles or chunks to work on
SHARED_CONST uint kWorldTriangleBinding = 1;
SHARED_CONST uint kFieldKeyBinding = 2; // these three where no bricks are read
SHARED_CONST uint kFieldSeedBinding = 3;
SHARED_CONST uint kFieldSideBinding = 3;
SHARED_CONST uint kFieldFlipBinding = 0;   // where no list is read
SHARED_CONST uint kFieldSearchBinding = 1; // where no triangles are read
SHARED_CONST uint kFieldSweepBinding = 4;
SHARED_CONST uint kFieldCandidateBinding = 6;
SHARED_CONST uint kFieldNodeBinding = 5;
SHARED_CONST uint kNodeRowBinding = 7;
SHARED_CONST uint kFieldSplatBinding = 6;
SHARED_CONST uint kFieldBandBinding = 0;    // in place of a list
SHARED_CONST uint kFieldNewBandBinding = 2; // while it is written
SHARED_CONST uint kFieldObjectBinding = 6;
SHARED_CONST uint kFieldTileBinding = 7;
SHARED_CONST uint kFieldOpenBinding = 7;      // where tiles are not read
SHARED_CONST uint kNearestPointBinding = 0;   // and the one after it: where they are made
SHARED_CONST uint kFieldShownListBinding = 0; // and the two after it: lists of tiles that a view shows

// Texture units. A stage uses sixteen at most, but numbers go to eighty at least.
SHARED_CONST uint kDepthMeshUnit = 5;
SHARED_CONST uint kMaterialTextureUnit = 6; // and the four after it
SHARED_CONST uint kDepthUnit = 0;           // of the passes that read the G-buffer
SHARED_CONST uint kNormalUnit = 1;
SHARED_CONST uint kAlbedoUnit = 2;
SHARED_CONST uint kMaterialUnit = 3;
SHARED_CONST uint kEmissionUnit = 4;
SHARED_CONST uint kIdUnit = 5;
SHARED_CONST uint kTraceUnit = 6;
SHARED_CONST uint kEnvironmentUnit = 7;
SHARED_CONST uint kEnvironmentBrdfUnit = 8;
SHARED_CONST uint kColorUnit = 9;
SHARED_CONST uint kOverdrawUnit = 10;
SHARED_CONST uint kShadowUnit = 11;
SHARED_CONST uint kShadowReadsUnit = 15;
SHARED_CONST uint kShadowHalfUnit = 12;
SHARED_CONST uint kShadowMapUnit = 13;
SHARED_CONST uint kShadowMomentsUnit = 14;
SHARED_CONST uint kShadowRangeUnit = 31;
SHARED_CONST uint kMotionUnit = 24;
SHARED_CONST uint kHistoryUnit = 25;
SHARED_CONST uint kHistoryDepthUnit = 26;
SHARED_CONST uint kWorldFieldUnit = 16; // of those that read the world field; a unit a cascade
SHARED_CONST uint kOcclusionUnit = 24;  // behind the cascades
SHARED_CONST uint kOcclusionTracedUnit = 25;
SHARED_CONST uint kTranslucentUnit = 31;  // behind the bricks
SHARED_CONST uint kNearestPointUnit = 31; // where the world field is made
SHARED_CONST uint kThicknessUnit = 32;
SHARED_CONST uint kReflectionUnit = 33;
SHARED_CONST uint kReflectionHitUnit = 34;
SHARED_CONST uint kMotionTileUnit = 35;
SHARED_CONST uint kDistanceR8Unit = 26; // the bricks, which are read beside all of these
SHARED_CONST uint kDistanceR16Unit = 27;
SHARED_CONST uint kBrickBaseColorUnit = 28;
SHARED_CONST uint kBrickMaterialUnit = 29;
SHARED_CONST uint kBrickEmissionUnit = 30;

SHARED_END

#endif

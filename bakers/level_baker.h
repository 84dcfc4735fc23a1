// One level of a field out of distances, signs and attributes.
#pragma once

#include "bakers/attribute_baker.h"
#include "bakers/sign_flood.h"
#include "bakers/solid_thickness.h"

namespace brickfield {

struct LevelBakeRequest {
  LevelLayout layout;
  DistanceFormat format = DistanceFormat::R8Snorm; ///< complete levels are R16 whatever it says
  SamplingRequest sampling;
  const InsideTest* inside = nullptr;         ///< nothing where no triangle is solid
  const SolidThickness* thickness = nullptr;  ///< grows thin solids; nothing: they are as they are
  const AttributeBaker* attributes = nullptr; ///< nothing: the level gets none
  BakeStats* stats = nullptr;                 ///< seconds and queries are added to it; given always
  LargeVector<float>* signedVoxels = nullptr; ///< gets the distances before they are coded, if given
};

/// Attributes are exact within two voxels of the surface; farther samples repeat one of their brick.
BrickLevel bakeLevel(const LevelBakeRequest& request);

} // namespace brickfield

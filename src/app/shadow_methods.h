// The ways to shadows that `bench shadows` compares: one table. A new method is a row of it and, where it needs one, a
// member of ShadowSettings; the bench itself knows none of them by name.
#pragma once

#include <string>
#include <vector>

#include "renderer/settings.h"

namespace brickfield {

struct BenchedShadows {
  std::string name;
  std::string meaning;
  FieldMethod field = FieldMethod::Off; ///< whose world field is marched; Off: none
  int fieldFrames = 1;                  ///< that are drawn before anything is measured, where the field grows
  bool wantsBricks = false;             ///< of meshes too
  ShadowSettings settings;
  ShadowMapSettings maps{}; ///< where the method draws some
};
const std::vector<BenchedShadows>& benchedShadows();

/// Null: no such method.
const BenchedShadows* findBenchedShadows(const std::string& name);

} // namespace brickfield

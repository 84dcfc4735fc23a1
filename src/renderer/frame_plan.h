// The frame as a list. Order is the list's; the plan checks it and puts the barriers between.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "passes/pass.h"

namespace brickfield {

struct PlannedPass {
  PassDeclaration declaration;
  std::function<void()> record;     ///< GL only: no allocation, no file access
  std::uint32_t barriersBefore = 0; ///< bits of glMemoryBarrier
};

/// Fills in the barriers.
///
/// provided  what the host wrote before the frame
/// error     Failure: a pass reads what no earlier one wrote, unless it does without; two passes of one name
/// proved by tests/unit/renderer/frame_plan_test.cpp
void planFrame(std::vector<PlannedPass>& passes, const std::vector<ResourceUse>& provided);

} // namespace brickfield

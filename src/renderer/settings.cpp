// The views that there are.
#include "renderer/settings.h"

#include <fmt/format.h>

namespace brickfield {

const std::vector<DebugView>& debugViews() {
  constexpr float kStepsRange = 64, kOverdrawRange = 16;
  static const std::vector<DebugView> views{
      {"depth", "distance from the eye, near is bright", shared::DEBUG_VIEW_DEPTH},
      {"normal", "shading normal in world space, -1..1 as 0..1", shared::DEBUG_VIEW_NORMAL},
      {"albedo", "base colour", shared::DEBUG_VIEW_ALBEDO},
      {"id", "a colour for each node", shared::DEBUG_VIEW_ID},
      {"kind", "blue: mesh, orange: SDF object", shared::DEBUG_VIEW_KIND},
      {"steps", fmt::format("trace steps of the visible SDF object, blue 0 to red {}", kStepsRange),
       shared::DEBUG_VIEW_STEPS, kStepsRange},
      {"bricks", "a colour for each brick in which a ray ended", shared::DEBUG_VIEW_BRICKS},
      {"overdraw", fmt::format("box fragments of SDF objects at each pixel, blue 0 to red {}", kOverdrawRange),
       shared::DEBUG_VIEW_OVERDRAW, kOverdrawRange},
  };
  return views;
}

} // namespace brickfield

// The --light texts of the command line. Inner header of makeLighting.
#pragma once

#include <string>
#include <vector>

#include "scene/pose.h"

namespace brickfield {

/// "sun:X,Y,Z:DEGREES:LUX", "sphere:X,Y,Z:RADIUS:CANDELA", "rectangle:X,Y,Z:DX,DY,DZ:WIDTH,HEIGHT:CANDELA" (its
/// centre, where it shines, its width lying level; along X where it shines straight up or down) or "none" (alone).
/// error BadInput that names the flag and the text
std::vector<PosedLight> parseLightTexts(const std::vector<std::string>& lightTexts);

} // namespace brickfield

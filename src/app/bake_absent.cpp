// The build without Embree: what is in the cache is drawn, what is not cannot be baked.
#ifndef BRICKFIELD_BAKERS
#include "bakers/bake.h"
#include "core/error.h"

namespace brickfield {

BakeResult bakeField(const BakeInput& input, const BakeSettings&, const Progress&) {
  throw BadInput(input.label, "", "is not in the cache of baked bricks (--cache), and this build has no baker");
}

} // namespace brickfield
#endif

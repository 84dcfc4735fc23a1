// The build without Embree: what is in the cache is drawn, what is not cannot be baked.
#ifndef BRICKFIELD_BAKERS
#include "bakers/bake.h"
#include "bakers/bake_memory.h"
#include "bakers/job_pool.h"
#include "core/error.h"

namespace brickfield {

BakeResult bakeField(const BakeInput& input, const BakeSettings&, const Progress&) {
  throw BadInput(input.label, "", "is not in the cache of baked bricks (--cache), and this build has no baker");
}

void runJobs(std::size_t count, int, const std::function<void(std::size_t)>& job) {
  for (std::size_t i = 0; i < count; ++i) job(i);
}

std::uint64_t mostBakeBytes(int, std::size_t) { return 0; }

} // namespace brickfield
#endif

// The build without OpenImageIO: everything that would need it says so in one line.
#ifndef BRICKFIELD_BAKERS
#include "app/exr.h"

#include "core/error.h"

namespace brickfield {

namespace fs = std::filesystem;

void requireExr(const fs::path& path) {
  throw BadInput(path.string(), "", "this build has no OpenImageIO: it neither reads nor writes EXR; use .png");
}

void writeExrParts(const fs::path& path, const std::vector<ImagePart>&) { requireExr(path); }

std::vector<ImagePart> readExrParts(const fs::path& path) {
  requireExr(path);
  return {};
}

ImagePart readPngPart(const fs::path& path) {
  throw BadInput(path.string(), "", "this build has no OpenImageIO: it reads no images");
}

} // namespace brickfield
#endif

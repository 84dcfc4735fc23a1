// Files are opened by the reader of their kind only, never by trying every plugin on hostile bytes; sizes are checked
// on the header before pixels are allocated.
#ifdef BRICKFIELD_BAKERS
#include "app/exr.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "app/image.h"
#include "core/error.h"
#include "core/files.h"

namespace brickfield {

namespace fs = std::filesystem;

namespace {

constexpr int kMostParts = 64;
constexpr int kMostChannels = 64;
constexpr std::uint64_t kMostValues = std::uint64_t{1} << 30; // 4 GiB of floats a file

OIIO::ImageSpec specOf(const ImagePart& part) {
  OIIO::ImageSpec spec(static_cast<int>(part.size.x), static_cast<int>(part.size.y),
                       static_cast<int>(part.channels.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = part.channels;
  spec.attribute("compression", "zip");
  // Else the library writes the time of day, and no two files are alike.
  spec.attribute("DateTime", "1970:01:01 00:00:00");
  if (!part.name.empty()) spec.attribute("oiio:subimagename", part.name);
  return spec;
}

/// target  names the file in messages; path is where the bytes go
void writeParts(const fs::path& target, const fs::path& path, const std::vector<ImagePart>& parts) {
  const auto refuse = [&](const std::string& reason) {
    return BadInput(target.string(), "", "cannot be written: " + reason);
  };
  std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("openexr");
  if (!output) throw Failure("OpenImageIO has no EXR writer");
  std::vector<OIIO::ImageSpec> specs;
  for (const ImagePart& part : parts) specs.push_back(specOf(part));
  // A single part is opened plainly: the several-part form marks the file as one that older readers refuse.
  const bool isOpen = specs.size() == 1 ? output->open(path.string(), specs[0])
                                        : output->open(path.string(), static_cast<int>(specs.size()), specs.data());
  if (!isOpen) throw refuse(output->geterror());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0 && !output->open(path.string(), specs[i], OIIO::ImageOutput::AppendSubimage))
      throw refuse(output->geterror());
    if (!output->write_image(OIIO::TypeDesc::FLOAT, parts[i].values.data())) throw refuse(output->geterror());
  }
  if (!output->close()) throw refuse(output->geterror());
}

void checkSpec(const fs::path& path, const std::string& element, const OIIO::ImageSpec& spec,
               std::uint64_t& valuesLeft) {
  if (spec.deep) throw BadInput(path.string(), element, "deep data is not read");
  if (spec.width < 1 || spec.height < 1 || spec.depth != 1 || spec.nchannels < 1)
    throw BadInput(path.string(), element, "has no pixels");
  const int largestSide = static_cast<int>(kLargestImageSide);
  if (spec.width > largestSide || spec.height > largestSide || spec.nchannels > kMostChannels)
    throw BadInput(path.string(), element,
                   fmt::format("{} x {} pixels of {} channels, at most {} x {} of {} are read", spec.width, spec.height,
                               spec.nchannels, largestSide, largestSide, kMostChannels));
  const std::uint64_t values = spec.image_pixels() * static_cast<std::uint64_t>(spec.nchannels);
  if (values > valuesLeft) throw BadInput(path.string(), element, "more values than are read from one file");
  valuesLeft -= values;
}

std::vector<ImagePart> readParts(const fs::path& path, const char* format, const OIIO::ImageSpec& hints) {
  if (const std::string obstacle = obstacleToReading(path); !obstacle.empty())
    throw BadInput(path.string(), "", obstacle);
  std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
  if (!input) throw Failure(fmt::format("OpenImageIO has no reader of {}", format));
  OIIO::ImageSpec opened;
  if (!input->open(path.string(), opened, hints))
    throw BadInput(path.string(), "", fmt::format("is not a readable {} file: {}", format, input->geterror()));
  std::vector<ImagePart> parts;
  std::uint64_t valuesLeft = kMostValues;
  for (int index = 0; input->seek_subimage(index, 0); ++index) {
    const std::string element = fmt::format("part {}", index);
    if (index == kMostParts) throw BadInput(path.string(), element, fmt::format("more than {} parts", kMostParts));
    const OIIO::ImageSpec spec = input->spec();
    checkSpec(path, element, spec, valuesLeft);
    ImagePart part;
    part.name = spec.get_string_attribute("oiio:subimagename");
    part.size = {static_cast<unsigned>(spec.width), static_cast<unsigned>(spec.height)};
    part.channels = spec.channelnames;
    part.values.resize(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
    if (!input->read_image(index, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, part.values.data()))
      throw BadInput(path.string(), element, fmt::format("cannot be read: {}", input->geterror()));
    parts.push_back(std::move(part));
  }
  if (parts.empty()) throw BadInput(path.string(), "", "has no image in it");
  return parts;
}

} // namespace

void requireExr(const fs::path&) {}

void writeExrParts(const fs::path& path, const std::vector<ImagePart>& parts) {
  writeBesideAndRename(path, [&](const fs::path& beside) { writeParts(path, beside, parts); });
}

std::vector<ImagePart> readExrParts(const fs::path& path) { return readParts(path, "openexr", {}); }

ImagePart readPngPart(const fs::path& path) {
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  return std::move(readParts(path, "png", hints).front());
}

} // namespace brickfield
#endif

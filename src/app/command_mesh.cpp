// Reads, extracts, colours and writes.
#include "app/command_mesh.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/image_io.h"
#include "app/options.h"
#include "app/parse.h"
#include "app/progress_bar.h"
#include "app/session.h"
#include "core/error.h"
#include "core/files.h"
#include "field/brick_layout.h"
#include "field/bricks_file.h"
#include "field/iso_surface.h"
#include "field/surface_attributes.h"
#include "scene/glb_export.h"

namespace brickfield {

namespace {

struct MeshOptions {
  std::filesystem::path bricks;
  std::filesystem::path output;
  std::size_t level = 0;
  double isoMetres = 0;
};

/// Colours a vertex each; metallic, roughness and emission, which glTF has no vertex attributes for, as their means.
Material paint(const BrickField& field, std::size_t level, Primitive& primitive) {
  Material material;
  material.metallic = 0;
  if (field.levels[level].baseColor.empty()) return material;
  double metallic = 0, roughness = 0, count = 0;
  glm::dvec3 emission(0.0);
  primitive.colors.reserve(primitive.positions.size());
  for (const glm::vec3 position : primitive.positions) {
    const std::optional<SurfaceAttributes> found = attributesAt(field, level, position);
    primitive.colors.push_back(found ? found->baseColor : glm::vec4(1));
    if (!found) continue;
    metallic += found->metallic, roughness += found->roughness, ++count;
    emission += glm::dvec3(found->emission);
  }
  if (count == 0) return material;
  material.metallic = static_cast<float>(metallic / count);
  material.roughness = static_cast<float>(roughness / count);
  material.emission = glm::vec3(emission / count);
  return material;
}

Primitive extract(const BrickField& field, const MeshOptions& options) {
  ProgressBar bar;
  IsoSurface surface = extractIsoSurface(field, options.level, options.isoMetres, bar.progress());
  if (surface.indices.empty())
    throw BadInput(options.bricks.string(), fmt::format("level {}", options.level), "has no surface there");
  Primitive primitive;
  primitive.positions = std::move(surface.positions);
  primitive.normals = std::move(surface.normals);
  primitive.indices = std::move(surface.indices);
  return primitive;
}

int writeMesh(const MeshOptions& options) {
  checkOutputs({{"-o", options.output, {".glb"}}}, {options.bricks});
  const BrickField field = readBricksFile(options.bricks);
  if (options.level >= field.levels.size())
    throw BadInput("--level", fmt::format("{}", options.level),
                   fmt::format("{} has {}, from 0, the finest", options.bricks.string(), field.levels.size()));
  const double most = kMostIsoVoxels * field.levels[options.level].voxelSizeObject;
  if (std::abs(options.isoMetres) > most)
    throw BadInput(
        "--iso", fmt::format("{:g}", options.isoMetres),
        fmt::format("is more than {:.4g} metres, {} voxels of level {}", most, kMostIsoVoxels, options.level));
  Primitive primitive = extract(field, options);
  const Material material = paint(field, options.level, primitive);
  throwIfInterrupted();
  const std::vector<std::byte> file = encodeGlb(options.bricks.stem().string(), primitive, material);
  writeFile(options.output, file);
  fmt::print("{}: {} vertices, {} triangles, {:.2f} MiB, level {}{}\n", options.output.string(),
             primitive.positions.size(), primitive.indices.size() / 3,
             static_cast<double>(file.size()) / (1024.0 * 1024.0), options.level,
             primitive.colors.empty() ? "" : ", with colours");
  return 0;
}

} // namespace

void addMeshCommand(CLI::App& program, CommandAction& chosen) {
  CLI::App& command = *program.add_subcommand("mesh", "Write the surface of a .bricks file as triangles");
  const auto options = std::make_shared<MeshOptions>();
  addPath(command, "BRICKS", "The .bricks file", options->bricks)->required();
  addPath(command, "-o,--output", "The .glb file to write", options->output)->required();
  addValue(command, "--level", "Level of resolution, from 0, the finest and default", [=](auto& flag, auto& text) {
    options->level = static_cast<std::size_t>(parseWhole(flag, text, 0, kMaxLevels - 1));
  })->type_name("N");
  addValue(command, "--iso", "So many metres outside of the surface, negative: inside; up to 0.9 voxels; 0 by default",
           [=](auto& flag, auto& text) { options->isoMetres = parseNumber(flag, text, -1e6, 1e6); })
      ->type_name("M");
  command.callback([options, &chosen] { chosen = [options] { return writeMesh(*options); }; });
}

} // namespace brickfield

// Every stage in every variant that the passes ask for compiles and links, and no shader file lies around unused.
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "gpu/shader_library.h"
#include "gpu/shader_source.h"
#include "tests/support/gl_fixture.h"

namespace brickfield::test {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

const fs::path kSource = BRICKFIELD_SOURCE_DIR;

// Each way to march shadows, after shadow maps or without, counting or not.
std::vector<ProgramSource> marchedShadows() {
  std::vector<ProgramSource> all;
  for (const std::string name : {"field_shadow", "brick_shadow", "published_shadow"})
    for (const bool mapsDecide : {false, true})
      for (const bool counts : {false, true}) {
        ProgramSource source{name, {{GL_COMPUTE_SHADER, "passes/" + name + ".comp.glsl"}}, {}, {}};
        if (mapsDecide) source.label += "_maps", source.defines["MAPS_DECIDE"] = "1";
        if (counts) source.label += "_counting", source.defines["COUNTERS_ON"] = "1";
        all.push_back(std::move(source));
      }
  return all;
}

std::vector<ProgramSource> tableOfPrograms() {
  const auto compute = [](const std::string& label, const std::string& path,
                          std::map<std::string, std::string> defines = {}) {
    return ProgramSource{label, {{GL_COMPUTE_SHADER, path}}, std::move(defines), {}};
  };
  const auto draw = [](const std::string& label, const std::string& vertex, const std::string& fragment,
                       std::map<std::string, std::string> defines) {
    return ProgramSource{label, {{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}}, std::move(defines), {}};
  };
  std::vector<ProgramSource> table{
      compute("clear", "passes/clear.comp.glsl"),
      compute("deform", "passes/deform.comp.glsl"),
      compute("sdf_cull", "passes/sdf_cull.comp.glsl"),
      compute("sdf_screen_boxes", "passes/sdf_screen_boxes.comp.glsl"),
      compute("sdf_tiles", "passes/sdf_tiles.comp.glsl"),
      compute("sdf_tiles_counting", "passes/sdf_tiles.comp.glsl", {{"COUNTERS_ON", "1"}}),
      draw("mesh", "passes/mesh.vert.glsl", "passes/mesh.frag.glsl", {}),
      draw("mesh_masked", "passes/mesh.vert.glsl", "passes/mesh.frag.glsl", {{"ALPHA_MASK", "1"}}),
      draw("mesh_motion", "passes/mesh.vert.glsl", "passes/mesh.frag.glsl", {{"MOTION_ON", "1"}}),
      draw("mesh_motion_masked", "passes/mesh.vert.glsl", "passes/mesh.frag.glsl",
           {{"ALPHA_MASK", "1"}, {"MOTION_ON", "1"}}),
      draw("sdf_box", "passes/sdf_box.vert.glsl", "passes/sdf_box.frag.glsl", {}),
      draw("sdf_box_counting", "passes/sdf_box.vert.glsl", "passes/sdf_box.frag.glsl", {{"COUNTERS_ON", "1"}}),
      draw("triplanar", "passes/triplanar.vert.glsl", "passes/triplanar.frag.glsl", {}),
      draw("shadow_map", "passes/shadow_map.vert.glsl", "passes/shadow_map.frag.glsl", {}),
      draw("shadow_map_masked", "passes/shadow_map.vert.glsl", "passes/shadow_map.frag.glsl", {{"ALPHA_MASK", "1"}}),
      draw("shadow_map_box", "passes/sdf_box.vert.glsl", "passes/sdf_box.frag.glsl", {{"DEPTH_ONLY", "1"}}),
      draw("shadow_map_box_counting", "passes/sdf_box.vert.glsl", "passes/sdf_box.frag.glsl",
           {{"COUNTERS_ON", "1"}, {"DEPTH_ONLY", "1"}}),
      compute("shadow_moments", "passes/shadow_moments.comp.glsl"),
      compute("map_shadow", "passes/map_shadow.comp.glsl"),
      compute("shadow_range", "passes/shadow_range.comp.glsl"),
      compute("shadow_map_view", "debug/shadow_map_view.comp.glsl"),
      draw("box_overdraw", "passes/sdf_box.vert.glsl", "debug/box_overdraw.frag.glsl", {}),
      compute("environment_prefilter", "passes/environment_prefilter.comp.glsl"),
      compute("environment_brdf", "passes/environment_brdf.comp.glsl"),
      compute("lighting", "passes/lighting.comp.glsl"),
      compute("taa", "passes/taa.comp.glsl"),
      compute("motion", "passes/motion.comp.glsl"),
      compute("motion_tiles", "passes/motion_tiles.comp.glsl"),
      compute("motion_blur", "passes/motion_blur.comp.glsl"),
      compute("taa_sharpen", "passes/taa_sharpen.comp.glsl"),
      compute("taa_view", "debug/taa_view.comp.glsl"),
      compute("tone", "passes/tone.comp.glsl"),
      compute("world_triangles", "passes/world_triangles.comp.glsl"),
      compute("world_pseudonormals", "passes/world_pseudonormals.comp.glsl"),
      compute("field_clear", "passes/field_clear.comp.glsl"),
      compute("field_splat", "passes/field_splat.comp.glsl"),
      compute("field_splat_parts", "passes/field_splat_parts.comp.glsl"),
      compute("field_seeds", "passes/field_seeds.comp.glsl"),
      compute("field_sweep", "passes/field_sweep.comp.glsl"),
      compute("field_candidates", "passes/field_candidates.comp.glsl"),
      compute("field_evaluate", "passes/field_evaluate.comp.glsl"),
      compute("field_refine", "passes/field_refine.comp.glsl"),
      {"field_refine_listed", {{GL_COMPUTE_SHADER, "passes/field_refine.comp.glsl"}}, {{"LISTED", "1"}}, {}},
      compute("field_far_values", "passes/field_far_values.comp.glsl"),
      compute("field_far", "passes/field_far.comp.glsl"),
      compute("field_sides", "passes/field_sides.comp.glsl"),
      compute("field_objects", "passes/field_objects.comp.glsl"),
      compute("field_objects_search", "passes/field_objects_search.comp.glsl"),
      compute("field_objects_store", "passes/field_objects_store.comp.glsl"),
      compute("nearest_points", "passes/nearest_points.comp.glsl"),
      {"field_objects_flipped", {{GL_COMPUTE_SHADER, "passes/field_objects.comp.glsl"}}, {{"FLIPPED", "1"}}, {}},
      compute("field_occlusion", "passes/field_occlusion.comp.glsl"),
      {"field_occlusion_counting",
       {{GL_COMPUTE_SHADER, "passes/field_occlusion.comp.glsl"}},
       {{"COUNTERS_ON", "1"}},
       {}},
      {"field_occlusion_side_by_side",
       {{GL_COMPUTE_SHADER, "passes/field_occlusion.comp.glsl"}},
       {{"SIDE_BY_SIDE", "1"}},
       {}},
      {"field_occlusion_side_by_side_counting",
       {{GL_COMPUTE_SHADER, "passes/field_occlusion.comp.glsl"}},
       {{"COUNTERS_ON", "1"}, {"SIDE_BY_SIDE", "1"}},
       {}},
      compute("occlusion_spread", "passes/occlusion_spread.comp.glsl"),
      {"occlusion_spread_counting",
       {{GL_COMPUTE_SHADER, "passes/occlusion_spread.comp.glsl"}},
       {{"COUNTERS_ON", "1"}},
       {}},
      compute("translucency", "passes/translucency.comp.glsl"),
      {"translucency_counting", {{GL_COMPUTE_SHADER, "passes/translucency.comp.glsl"}}, {{"COUNTERS_ON", "1"}}, {}},
      compute("shadow_fill", "passes/shadow_fill.comp.glsl"),
      compute("shadow_fill_counting", "passes/shadow_fill.comp.glsl", {{"COUNTERS_ON", "1"}}),
      compute("reflection_places", "passes/reflection_places.comp.glsl"),
      compute("field_reflection", "passes/field_reflection.comp.glsl"),
      compute("field_reflection_counting", "passes/field_reflection.comp.glsl", {{"COUNTERS_ON", "1"}}),
      compute("field_reflection_bricks", "passes/field_reflection.comp.glsl", {{"BRICKS_ON", "1"}}),
      compute("field_reflection_bricks_counting", "passes/field_reflection.comp.glsl",
              {{"BRICKS_ON", "1"}, {"COUNTERS_ON", "1"}}),
      compute("reflection_shade", "passes/reflection_shade.comp.glsl"),
      compute("reflection_spread", "passes/reflection_spread.comp.glsl"),
      compute("hierarchy_refit", "passes/hierarchy_refit.comp.glsl"),
      compute("rtsdf_voxelize", "passes/rtsdf_voxelize.comp.glsl"),
      compute("rtsdf_jump_flood", "passes/rtsdf_jump_flood.comp.glsl"),
      compute("rtsdf_rays", "passes/rtsdf_rays.comp.glsl"),
      {"rtsdf_rays_counting", {{GL_COMPUTE_SHADER, "passes/rtsdf_rays.comp.glsl"}}, {{"COUNTERS_ON", "1"}}, {}},
      compute("debug_view", "debug/debug_view.comp.glsl"),
      compute("field_view", "debug/field_view.comp.glsl"),
  };
  for (ProgramSource& source : marchedShadows()) table.push_back(std::move(source));
  return table;
}

const std::vector<ProgramSource>& programs() {
  static const std::vector<ProgramSource> table = tableOfPrograms();
  return table;
}

std::string textOf(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

// What the first group of a pattern matches in all files with an ending below a folder.
Names matches(const fs::path& folder, const std::string& ending, const std::regex& pattern) {
  Names found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || entry.path().extension() != ending) continue;
    const std::string text = textOf(entry.path());
    for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
      found.insert((*match)[1]);
  }
  return found;
}

bool isStage(const std::string& path) {
  return path.ends_with(".vert.glsl") || path.ends_with(".frag.glsl") || path.ends_with(".comp.glsl") ||
         path.ends_with(".geom.glsl") || path.ends_with(".tesc.glsl") || path.ends_with(".tese.glsl");
}

Names stagesOfTable() {
  Names stages;
  for (const ProgramSource& program : programs())
    for (const auto& [stage, path] : program.stages) stages.insert(path);
  return stages;
}

class EveryShader : public GlTest {};

TEST_F(EveryShader, CompilesAndLinksInEveryVariant) {
  ShaderLibrary library(kSource / "shaders");
  for (const ProgramSource& source : programs()) EXPECT_NO_THROW(library.load(source)) << source.label;
  EXPECT_EQ(library.programCount(), programs().size()) << "two rows of the table are the same program";
}

TEST_F(EveryShader, IsInTheTable) {
  Names stages;
  for (const std::string& path : allShaderFiles(kSource / "shaders"))
    if (isStage(path)) stages.insert(path);
  EXPECT_EQ(stages, stagesOfTable());
}

TEST_F(EveryShader, IsLoadedByAPass) {
  const std::regex path("\"([a-z_/]+\\.(?:vert|frag|comp)\\.glsl)\"");
  EXPECT_EQ(matches(kSource / "src/passes", ".cpp", path), stagesOfTable());
}

TEST_F(EveryShader, VariantIsInTheTable) {
  // Switches of shaders are the conditions that are no include guards and not the bridge's.
  Names switches =
      matches(kSource / "shaders", ".glsl", std::regex("#\\s*(?:ifdef|ifndef|if defined\\()\\s*([A-Z_0-9]+)"));
  Names defined;
  for (const ProgramSource& source : programs())
    for (const auto& [name, value] : source.defines) defined.insert(name);
  EXPECT_EQ(switches, defined);
  for (const std::string& name : matches(kSource / "src/passes", ".cpp", std::regex("\\{\"([A-Z_0-9]+)\", \"")))
    EXPECT_TRUE(defined.count(name)) << name;
}

TEST_F(EveryShader, LibraryFileIsIncludedBySomeStage) {
  Names included;
  for (const std::string& stage : stagesOfTable())
    for (const std::string& file : assembleShader(kSource / "shaders", stage, {}).files) included.insert(file);
  for (const std::string& path : allShaderFiles(kSource / "shaders"))
    EXPECT_TRUE(included.count(path)) << path << " is used by nobody";
}

} // namespace
} // namespace brickfield::test

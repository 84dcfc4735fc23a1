// The picture of the world field's errors: dark where the exact field is right, and not where it is made wrong.
#include "app/field_error_view.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {
namespace {

using ::testing::HasSubstr;

constexpr glm::uvec2 kSize{64, 64};

class FieldErrorView : public GlTest {
protected:
  static constexpr glm::vec3 kWrongSide{1, 0, 1};

  FieldErrorView() : scene_(makeTorusAlone(), "none") {
    RendererSettings settings;
    settings.view = "field";
    settings.worldField.shape = {1, 64, 0, true};
    const auto renderer = scene_.makeRenderer(context().info(), settings);
    renderer->render(scene_.autoView(kSize));
    field_ = renderer->readWorldField();
    plane_ = renderer->fieldPicture();
  }
  RgbImage picture() const {
    return fieldErrorPicture(field_, plane_, kSize, scene_.scene(), scene_.pose(), scene_.fields().fieldOfNode);
  }
  template <typename Is>
  static std::size_t count(const RgbImage& image, Is is) {
    return static_cast<std::size_t>(std::count_if(image.pixels.begin(), image.pixels.end(), is));
  }
  // Of the heat scale: green begins at nothing and ends at one half of red's error or so.
  static bool isSmall(glm::vec3 color) { return color.x == 0 && color.y < 0.45f; }

  TestScene scene_;
  FieldVolumes field_;
  FieldPicture plane_;
};

TEST_F(FieldErrorView, IsDarkWhereTheFieldIsRight) {
  const RgbImage image = picture();
  ASSERT_EQ(image.pixels.size(), 64u * 64u);
  EXPECT_EQ(count(image, [](glm::vec3 color) { return color == kWrongSide; }), 0u);
  EXPECT_GT(count(image, isSmall), 3000u);
  EXPECT_LT(count(image, [](glm::vec3 color) { return color.x > 0.9f; }), 10u);
}

TEST_F(FieldErrorView, ShowsWhatIsTooLarge) {
  for (float& texels : field_.cascades[0].distances) texels += 0.5f;
  EXPECT_GT(count(picture(), [](glm::vec3 color) { return color.x > 0.8f; }), 500u) << "outside, and near inside";
}

TEST_F(FieldErrorView, ShowsWrongSides) {
  for (float& texels : field_.cascades[0].distances) texels = -texels;
  EXPECT_GT(count(picture(), [](glm::vec3 color) { return color == kWrongSide; }), 2500u);
}

TEST_F(FieldErrorView, IsPartOfTheList) {
  ASSERT_NE(fieldErrorView(), nullptr);
  EXPECT_THAT(fieldErrorView()->meaning, HasSubstr("red 0.5"));
}

// Of bricks a quarter of a texel fine; against what they were baked from.
TEST_F(FieldErrorView, IsDarkWhereTheFieldOfObjectsIsRight) {
  const TestScene scene(makeTorusAlone(), "all", 128);
  RendererSettings settings;
  settings.view = "field";
  settings.worldField.shape = {1, 64, 0, true};
  const auto renderer = scene.makeRenderer(context().info(), settings);
  renderer->render(scene.autoView(kSize));
  FieldVolumes field = renderer->readWorldField();
  const auto countLight = [&] {
    const RgbImage image = fieldErrorPicture(field, renderer->fieldPicture(), kSize, scene.scene(), scene.pose(),
                                             scene.fields().fieldOfNode);
    return std::count_if(image.pixels.begin(), image.pixels.end(), [](glm::vec3 color) { return color.x > 0.2f; });
  };
  EXPECT_LT(countLight(), 30);
  for (float& texels : field.cascades[0].distances) texels += 0.4f;
  EXPECT_GT(countLight(), 500);
}

// Inside both of two objects the deeper counts, not the surface that lies buried.
TEST_F(FieldErrorView, IsDarkWhereObjectsReachIntoEachOther) {
  Scene spheres = makeTorusAlone();
  spheres.meshes[0] = makeSphereMesh(0.5f, 48, 96);
  Node second = spheres.nodes[0];
  second.matrix = glm::translate(glm::mat4(1), {0.5f, 0, 0});
  spheres.scenes[0].nodes.push_back(static_cast<int>(spheres.nodes.size()));
  spheres.nodes.push_back(second);
  const TestScene scene(std::move(spheres), "all", 64);
  RendererSettings settings;
  settings.view = "field";
  settings.worldField.shape = {1, 64, 0, true};
  const auto renderer = scene.makeRenderer(context().info(), settings);
  renderer->render(scene.autoView(kSize));
  const RgbImage image = fieldErrorPicture(renderer->readWorldField(), renderer->fieldPicture(), kSize, scene.scene(),
                                           scene.pose(), scene.fields().fieldOfNode);
  EXPECT_LT(count(image, [](glm::vec3 color) { return color.x > 0.2f; }), 30u);
}

} // namespace
} // namespace brickfield::test

// Projection, framing and primary rays.
#include "scene/view.h"

#include <gtest/gtest.h>

#include "core/error.h"

using namespace brickfield;

namespace {

/// Pixel and depth of a point, in double, from the view's own matrix.
glm::dvec3 rasterize(const View& view, glm::dvec3 pointWorld) {
  const glm::dvec4 clip = glm::dmat4(view.clipFromView) * glm::dmat4(view.viewFromWorld) * glm::dvec4(pointWorld, 1.0);
  return {(clip.x / clip.w * 0.5 + 0.5) * view.sizePixels.x, (0.5 - clip.y / clip.w * 0.5) * view.sizePixels.y,
          clip.z / clip.w};
}

/// Largest distance in pixels between a ray's own pixel and where its points are rasterized.
double rayError(const View& view) {
  double worst = 0;
  for (const glm::vec2 share :
       {glm::vec2(0), glm::vec2(0.5f), glm::vec2(1), glm::vec2(0.1f, 0.9f), glm::vec2(0.73f, 0.2f)})
    for (const double t : {1.0, 10.0, 1000.0}) {
      const glm::vec2 pixel = share * glm::vec2(view.sizePixels);
      const PrimaryRay ray = primaryRay(view, pixel);
      const glm::dvec3 seen = rasterize(view, glm::dvec3(ray.originWorld) + t * glm::dvec3(ray.directionWorld));
      worst = std::max(worst, glm::length(glm::dvec2(seen) - glm::dvec2(pixel)));
    }
  return worst;
}

/// The direction's components are rounded by at most 2^-25 each; a pixel's width is 2 tan(fov / 2) / height of them.
/// With rounding of the view matrix's rotation the same again.
double rayBound(const View& view) { return view.sizePixels.y * view.clipFromView[1][1] * std::ldexp(4.0, -25); }

Scene cameraScene() {
  Scene scene;
  scene.name = "cameras.glb";
  scene.nodes.resize(2);
  scene.nodes[0].camera = 0;
  scene.nodes[0].name = "wide";
  scene.nodes[1].camera = 1;
  scene.cameras.resize(2);
  scene.cameras[0].verticalFovRadians = 1.0f;
  scene.cameras[1].name = "flat";
  scene.cameras[1].orthographic = true;
  scene.cameras[1].halfExtent = {2, 2};
  scene.cameras[1].nearDistance = 0.5f;
  scene.cameras[1].farDistance = 10.0f;
  scene.scenes.push_back({"", {0, 1}});
  return scene;
}

CameraRequest requestOf(const std::string& camera, glm::uvec2 size = {200, 100}) {
  CameraRequest request;
  request.camera = camera;
  request.sizePixels = size;
  return request;
}

} // namespace

TEST(View, ReverseDepthIsOneAtNearAndZeroAtInfinity) {
  const View view = makePerspectiveView({0, 0, 0}, {0, 0, -1}, 1.0f, 0.25f, {100, 100});
  EXPECT_NEAR(rasterize(view, {0, 0, -0.25}).z, 1.0, 1e-7);
  EXPECT_NEAR(rasterize(view, {0, 0, -1}).z, 0.25, 1e-7);
  EXPECT_NEAR(rasterize(view, {0, 0, -1e30}).z, 0.0, 1e-20);
  const glm::mat4 product = view.clipFromWorld * view.worldFromClip;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) EXPECT_NEAR(product[c][r], c == r ? 1.0f : 0.0f, 1e-5f);
}

TEST(View, RaysMeetTheirOwnPixel) {
  for (const glm::uvec2 size : {glm::uvec2(1280, 720), glm::uvec2(64, 64), glm::uvec2(37, 501)}) {
    const View view = makePerspectiveView({1, 2, 3}, {-4, 0.5f, -7}, 0.9f, 0.01f, size);
    EXPECT_LE(rayError(view), rayBound(view)) << size.x << "x" << size.y;
    const PrimaryRay corner = primaryRay(view, {0, 0});
    EXPECT_NEAR(glm::length(corner.directionWorld), 1.0f, 1e-6f);
    const glm::dvec3 atNear = glm::dvec3(corner.originWorld) + double{corner.tNear} * glm::dvec3(corner.directionWorld);
    EXPECT_NEAR(rasterize(view, atNear).z, 1.0, 1e-4);
  }
}

TEST(View, RowsCountDownwards) {
  const View view = makePerspectiveView({0, 0, 0}, {0, 0, -1}, 1.0f, 0.1f, {100, 100});
  EXPECT_GT(primaryRay(view, {50, 0}).directionWorld.y, 0.1f);
  EXPECT_LT(primaryRay(view, {0, 50}).directionWorld.x, -0.1f);
}

TEST(View, LookingStraightDownStillHasAFrame) {
  for (const float direction : {1.0f, -1.0f}) {
    const View view = makePerspectiveView({1, 2, 3}, {1, 2 + direction, 3}, 1.0f, 0.1f, {64, 64});
    EXPECT_NEAR(glm::determinant(glm::mat3(view.worldFromView)), 1.0f, 1e-6f);
    EXPECT_NEAR(primaryRay(view, {32, 32}).directionWorld.y, direction, 1e-6f);
  }
}

TEST(View, CameraNodesAreFoundByNumberAndName) {
  const Scene scene = cameraScene();
  const Pose pose = poseScene(scene, {});
  EXPECT_FALSE(makeView(scene, pose, requestOf("")).orthographic) << "the first one";
  EXPECT_TRUE(makeView(scene, pose, requestOf("1")).orthographic);
  EXPECT_TRUE(makeView(scene, pose, requestOf("flat")).orthographic);
  EXPECT_FALSE(makeView(scene, pose, requestOf("wide")).orthographic);
  EXPECT_THROW(makeView(scene, pose, requestOf("2")), BadInput);
  EXPECT_THROW(makeView(scene, pose, requestOf("-1")), BadInput);
  EXPECT_THROW(makeView(scene, pose, requestOf("narrow")), BadInput);
}

TEST(View, ImageAspectRulesAndVerticalFieldStays) {
  const Scene scene = cameraScene();
  const Pose pose = poseScene(scene, {});
  const View view = makeView(scene, pose, requestOf("0"));
  const double top = std::tan(0.5); // half of the field of 1 rad, at 1 m
  EXPECT_NEAR(rasterize(view, {0, top, -1}).y, 0.0, 1e-4);
  EXPECT_NEAR(rasterize(view, {2 * top, 0, -1}).x, 200.0, 1e-3);
}

TEST(View, OrthographicRaysAreParallelAndMeetTheirPixel) {
  const Scene scene = cameraScene();
  const Pose pose = poseScene(scene, {});
  const View view = makeView(scene, pose, requestOf("1"));
  EXPECT_NEAR(rasterize(view, {0, 0, -0.5}).z, 1.0, 1e-6);
  EXPECT_NEAR(rasterize(view, {0, 0, -10}).z, 0.0, 1e-6);
  EXPECT_NEAR(rasterize(view, {4, 2, -3}).x, 200.0, 1e-4) << "half height 2, image twice as wide";
  const PrimaryRay ray = primaryRay(view, {150, 25});
  EXPECT_EQ(ray.directionWorld, glm::vec3(0, 0, -1));
  EXPECT_NEAR(ray.originWorld.x, 2.0f, 1e-6f);
  EXPECT_NEAR(ray.originWorld.y, 1.0f, 1e-6f);
  EXPECT_EQ(ray.tNear, 0.5f);
  EXPECT_LT(rayError(view), 1e-4);
}

TEST(View, ScaledMirroredShearedCameraNodesGiveARigidFrame) {
  Scene scene = cameraScene();
  glm::mat4 odd(1.0f);
  odd[0] = {-3, 0, 0, 0};
  odd[1] = {0.4f, 0.1f, 0, 0};
  odd[2] = {0.3f, 0, 5, 0};
  odd[3] = {1, 2, 3, 1};
  scene.nodes[0].matrix = odd;
  const Pose pose = poseScene(scene, {});
  const View view = makeView(scene, pose, requestOf("0"));
  const glm::mat3 axes(view.worldFromView);
  const glm::mat3 square = glm::transpose(axes) * axes;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) EXPECT_NEAR(square[c][r], c == r ? 1.0f : 0.0f, 1e-6f);
  EXPECT_NEAR(glm::determinant(axes), 1.0f, 1e-6f);
  const glm::vec3 gaze = glm::normalize(-glm::vec3(odd[2]));
  EXPECT_NEAR(glm::dot(primaryRay(view, {100, 50}).directionWorld, gaze), 1.0f, 1e-6f);
  scene.nodes[0].matrix = glm::mat4(0.0f);
  (*scene.nodes[0].matrix)[3].w = 1.0f;
  EXPECT_NO_THROW(makeView(scene, poseScene(scene, {}), requestOf("0"))) << "a node scaled to nothing";
}

TEST(View, AutoShowsTheWholeBoundsAndFillsThePicture) {
  Pose pose;
  for (const Box& box :
       {Box{{-1, -1, -1}, {1, 1, 1}}, Box{{1000, 5, -7}, {1000.5f, 9, 800}}, Box{{0, 0, 0}, {1e-4f, 0, 0}}})
    for (const glm::uvec2 size : {glm::uvec2(1280, 720), glm::uvec2(100, 400)}) {
      pose.boundsWorld = box;
      const View view = makeView({}, pose, requestOf("auto", size));
      double largest = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 point((corner & 1 ? box.max : box.min).x, (corner & 2 ? box.max : box.min).y,
                               (corner & 4 ? box.max : box.min).z);
        const glm::dvec3 seen = rasterize(view, point);
        EXPECT_GT(seen.z, 0.0);
        EXPECT_LT(seen.z, 1.0) << "nothing before the near plane";
        const glm::dvec2 ndc = glm::abs(glm::dvec2(seen) / glm::dvec2(size) * 2.0 - 1.0);
        largest = std::max({largest, ndc.x, ndc.y});
      }
      EXPECT_NEAR(largest, 0.92, 1e-3) << "the margin";
    }
}

TEST(View, EmptySceneStillHasAView) {
  const View view = makeView({}, {}, requestOf(""));
  EXPECT_TRUE(isFinite(view.clipFromWorld));
  EXPECT_TRUE(isFinite(view.worldFromClip));
  EXPECT_GT(view.nearDistance, 0.0f);
}

TEST(View, EyeAndTargetOverrideThePlace) {
  const Scene scene = cameraScene();
  const Pose pose = poseScene(scene, {});
  CameraRequest request = requestOf("");
  request.eye = glm::vec3(0, 0, 5);
  request.target = glm::vec3(0, 5, 5);
  request.verticalFovDegrees = 90.0f;
  const View view = makeView(scene, pose, request);
  EXPECT_EQ(view.eyeWorld, glm::vec3(0, 0, 5));
  EXPECT_NEAR(primaryRay(view, {100, 50}).directionWorld.y, 1.0f, 1e-6f);
  EXPECT_NEAR(view.clipFromView[1][1], 1.0f, 1e-6f);
  request.target = request.eye;
  EXPECT_THROW(makeView(scene, pose, request), BadInput);
  request.target.reset();
  for (const float degrees : {0.0f, 180.0f, -5.0f, NAN}) {
    request.verticalFovDegrees = degrees;
    EXPECT_THROW(makeView(scene, pose, request), BadInput) << degrees;
  }
}

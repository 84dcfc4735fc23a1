// One of the two methods, over one buffer of triangles.
#include "renderer/field_keeper.h"

#include <algorithm>

#include "passes/world_field/nearest_points.h"

namespace brickfield {

namespace {

Box anchoredBox(const Box& boundsWorld, glm::dvec3 anchorWorld) {
  if (boundsWorld.isEmpty()) return {};
  return {glm::vec3(glm::dvec3(boundsWorld.min) - anchorWorld), glm::vec3(glm::dvec3(boundsWorld.max) - anchorWorld)};
}

bool holds(const Box& outer, const Box& inner) {
  return inner.isEmpty() ||
         (glm::all(glm::lessThanEqual(outer.min, inner.min)) && glm::all(glm::greaterThanEqual(outer.max, inner.max)));
}

// The picture's right and up as one looks against the axis, from its positive end.
struct SliceAxes {
  int right, up;
  float rightSign, upSign;
};
constexpr SliceAxes kSliceAxes[3] = {{2, 1, -1, 1}, {0, 2, 1, -1}, {0, 1, 1, 1}};

constexpr float kPictureMargin = 1.1f; // of bounds, so that the outside shows

std::uint32_t tilesOf(const FieldWindow& window) {
  const auto side = static_cast<std::uint32_t>(window.tiles());
  return side * side * side;
}

} // namespace

FieldKeeper::FieldKeeper(const Scene& scene, const SceneFields& fields, const ResidentScene& resident,
                         const FieldSettings& settings)
    : scene_(&scene),
      resident_(&resident),
      settings_(settings),
      triangles_(scene, fields, resident,
                 settings.method == FieldMethod::Exact ? SmallHoles::Closed : SmallHoles::Open) {
  if (settings_.method == FieldMethod::Exact) {
    exact_.emplace(settings_.shape);
    return;
  }
  rtsdf_.emplace(settings_.rtsdf);
  hierarchy_.emplace(scene);
  rtsdfParams_ = Buffer("rtsdf_field_params", sizeof(shared::FieldParams));
}

const FieldFrame& FieldKeeper::prepare(const Pose& pose, const View& view, const FieldSlice& slice) {
  if (exact_)
    prepareExact(pose, view);
  else
    prepareRtsdf(pose);
  frame_.picture = pictureOf(pose, view, slice);
  count(static_cast<std::uint32_t>(triangles_.moved().size()));
  return frame_;
}

void FieldKeeper::prepareExact(const Pose& pose, const View& view) {
  const glm::dvec3 eyeWorld(view.eyeWorld);
  const glm::dvec3 anchor = exact_->anchorFor(pose.boundsWorld, eyeWorld);
  const bool isNew = triangles_.setPose(*scene_, pose, anchor);
  exact_->update(triangles_, *resident_, isNew, eyeWorld);
  frame_.exact = &exact_->exact();
}

void FieldKeeper::prepareRtsdf(const Pose& pose) {
  if (!rtsdfAnchor_)
    rtsdfAnchor_ = pose.boundsWorld.isEmpty()
                       ? glm::dvec3(0)
                       : 0.5 * (glm::dvec3(pose.boundsWorld.min) + glm::dvec3(pose.boundsWorld.max));
  const bool isNew = triangles_.setPose(*scene_, pose, *rtsdfAnchor_);
  hierarchy_->update(triangles_, isNew);
  // The volume stays where it is while it holds the scene, because a new place forgets what equation 1 has summed up.
  const Box& bounds = triangles_.boundsAnchored();
  if (!holds(rtsdfBounds_, bounds)) rtsdfBounds_.extend(bounds);
  rtsdf_->place(rtsdfBounds_);
  rtsdf_->reserveTriangles(triangles_.triangleCount());
  shared::FieldParams params{};
  params.cascades[0] = rtsdf_->cascade();
  params.counts = {1, 0, 0, 0};
  params.anchor = glm::vec4(*rtsdfAnchor_, 0);
  rtsdfParams_.uploadValue(params);
  frame_.rtsdf = &*rtsdf_;
  frame_.hierarchy = &hierarchy_->hierarchy();
  frame_.rtsdfParams = &rtsdfParams_;
}

void FieldKeeper::settle() { triangles_.settle(); }

Box FieldKeeper::shownBounds(const Pose& pose, int cascade) const {
  if (cascade >= 0 && exact_) return exact_->exact().windows()[static_cast<std::size_t>(cascade)].boundsAnchored();
  const Box scene = anchoredBox(pose.boundsWorld, anchorWorld());
  if (cascade < 0 && !scene.isEmpty() && isFinite(scene.min) && isFinite(scene.max)) return scene;
  if (exact_) return exact_->exact().windows().front().boundsAnchored();
  const glm::vec3 origin = rtsdf_->originAnchored();
  return {origin, origin + glm::vec3(rtsdf_->extent()) * rtsdf_->cascade().texel.x};
}

FieldPicture FieldKeeper::pictureOf(const Pose& pose, const View& view, const FieldSlice& slice) const {
  const Box bounds = shownBounds(pose, slice.cascade);
  const SliceAxes axes = kSliceAxes[slice.axis];
  FieldPicture picture;
  picture.cascade = slice.cascade;
  picture.centerAnchored = bounds.center();
  if (slice.positionWorld)
    picture.centerAnchored[slice.axis] = static_cast<float>(*slice.positionWorld - anchorWorld()[slice.axis]);
  const glm::vec3 extent = bounds.extent();
  float metresPerPixel = std::max(extent[axes.right] / static_cast<float>(view.sizePixels.x),
                                  extent[axes.up] / static_cast<float>(view.sizePixels.y));
  if (slice.cascade < 0) metresPerPixel *= kPictureMargin;
  if (!(metresPerPixel > 0)) metresPerPixel = 1.0f / static_cast<float>(view.sizePixels.x); // one point: a metre
  picture.rightAnchored = picture.upAnchored = glm::vec3(0);
  picture.rightAnchored[axes.right] = axes.rightSign * metresPerPixel;
  picture.upAnchored[axes.up] = axes.upSign * metresPerPixel;
  return picture;
}

void FieldKeeper::count(std::uint32_t moved) {
  stats_ = {};
  stats_.method = settings_.method;
  stats_.cascades = static_cast<std::uint32_t>(frame_.cascadeCount());
  stats_.triangles = triangles_.triangleCount();
  stats_.movedInstances = moved;
  stats_.bytes.triangles = triangles_.bytes();
  if (!exact_) {
    stats_.bytes.hierarchy = hierarchy_->bytes();
    stats_.bytes.distances = rtsdf_->volume().bytes();
    stats_.bytes.work = rtsdf_->bytes() - stats_.bytes.distances;
    return;
  }
  using List = ExactField::List;
  const ExactField& exact = exact_->exact();
  for (std::size_t i = 0; i < exact.windows().size(); ++i) {
    stats_.tiles += tilesOf(exact.windows()[i]);
    stats_.bytes.distances += exact.distances(i).bytes();
  }
  stats_.keyTiles = exact.lengthOf(List::Keys);
  stats_.candidateTiles = exact.lengthOf(List::Candidates);
  stats_.valueTiles = exact.lengthOf(List::Values);
  stats_.bytes.nodes = exact.nodes().bytes();
  stats_.bytes.objects = NearestPoints::bytesFor(*resident_);
  stats_.bytes.work = exact.bytes() - stats_.bytes.distances - stats_.bytes.nodes;
}

namespace {

// From memory, where a texel lies at its lattice place modulo the extent, to the window's order.
std::vector<float> unwrapped(const std::vector<float>& stored, glm::ivec3 firstTexel, glm::ivec3 extent) {
  std::vector<float> values;
  values.reserve(stored.size());
  for (int z = 0; z < extent.z; ++z)
    for (int y = 0; y < extent.y; ++y)
      for (int x = 0; x < extent.x; ++x) {
        const glm::ivec3 slot = ((firstTexel + glm::ivec3(x, y, z)) % extent + extent) % extent;
        values.push_back(stored[static_cast<std::size_t>((slot.z * extent.y + slot.y) * extent.x + slot.x)]);
      }
  return values;
}

std::vector<std::uint32_t> unwrappedNodes(const std::vector<std::uint32_t>& stored, const FieldWindow& window) {
  std::vector<std::uint32_t> nodes;
  nodes.reserve(stored.size());
  const int side = window.texels, tiles = window.tiles();
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const glm::ivec3 slot = (window.firstTexel + glm::ivec3(x, y, z)) & (side - 1);
        const glm::ivec3 tile = slot >> 3, at = slot & 7;
        const int word = ((tile.z * tiles + tile.y) * tiles + tile.x) * 512 + (at.z * 8 + at.y) * 8 + at.x;
        nodes.push_back(stored[static_cast<std::size_t>(word)] & shared::FIELD_NODE_MASK);
      }
  return nodes;
}

} // namespace

FieldVolumes FieldKeeper::read() const {
  FieldVolumes volumes{anchorWorld(), {}};
  if (!exact_) {
    const shared::FieldCascade& cascade = rtsdf_->cascade();
    volumes.cascades.push_back({glm::ivec3(cascade.window),
                                rtsdf_->extent(),
                                cascade.texel.x,
                                cascade.texel.z,
                                true,
                                unwrapped(rtsdf_->volume().readFloats(), cascade.window, rtsdf_->extent()),
                                {}});
    return volumes;
  }
  const ExactField& exact = exact_->exact();
  std::size_t firstByte = 0;
  for (std::size_t i = 0; i < exact.windows().size(); ++i) {
    const FieldWindow& window = exact.windows()[i];
    const std::vector<float> stored = exact.distances(i).readFloats();
    volumes.cascades.push_back({window.firstTexel, glm::ivec3(window.texels), window.texelSize,
                                static_cast<float>(window.rangeTexels()), window.isWhole,
                                unwrapped(stored, window.firstTexel, glm::ivec3(window.texels)),
                                unwrappedNodes(exact.nodes().read<std::uint32_t>(firstByte, stored.size()), window)});
    firstByte += stored.size() * sizeof(std::uint32_t);
  }
  return volumes;
}

} // namespace brickfield

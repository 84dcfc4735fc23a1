// A part is a connected piece of one instance. Whether it is closed, and which way it faces, is found anew here with
// maps of rest positions, slowly and plainly; the caps of small holes are those of scene/surface_topology.h.
#include "bakers/field_truth.h"

#include <array>
#include <map>
#include <numeric>

#include <tbb/parallel_for.h>

#include "bakers/mesh_distance.h"
#include "bakers/winding_number.h"
#include "scene/surface_topology.h"

namespace brickfield {

namespace {

using Corners = std::array<glm::dvec3, 3>;

/// All triangles of a posed instance, of its rest too.
struct InstanceTriangles {
  std::vector<Corners> rest, world;
  std::vector<std::array<int, 3>> vertices; ///< welded by rest position and primitive kind
};

InstanceTriangles placeTriangles(const Scene& scene, const PosedInstance& instance) {
  InstanceTriangles result;
  std::map<std::array<float, 3>, int> numbers;
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
  const std::vector<SurfaceTopology::Cap> caps = analyseSurface(mesh).caps;
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    const Primitive& primitive = mesh.primitives[p];
    const std::vector<glm::vec3> deformed = deformPrimitive(primitive, instance).positions;
    std::vector<std::uint32_t> indices = primitive.indices;
    for (const SurfaceTopology::Cap& cap : caps)
      if (cap.primitive == p) indices.insert(indices.end(), cap.vertices.begin(), cap.vertices.end());
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      Corners rest, world;
      std::array<int, 3> vertices{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = indices[i + k];
        const glm::vec3 place = primitive.positions[v];
        rest[k] = place;
        world[k] = glm::dmat4(instance.worldFromObject) * glm::dvec4(glm::dvec3(deformed[v]), 1.0);
        vertices[k] =
            numbers.try_emplace({place.x + 0.0f, place.y + 0.0f, place.z + 0.0f}, numbers.size()).first->second;
      }
      result.rest.push_back(rest), result.world.push_back(world), result.vertices.push_back(vertices);
    }
  }
  return result;
}

double sixVolumes(const Corners& p, glm::dvec3 origin) {
  return glm::dot(p[0] - origin, glm::cross(p[1] - origin, p[2] - origin));
}
double area(const Corners& p) { return glm::length(glm::cross(p[1] - p[0], p[2] - p[0])) / 2; }

struct Part {
  std::vector<std::size_t> triangles;
  bool isClosed = false;
  bool isTurned = false; ///< faces the other way than at rest: mirrored
};

/// Connected by edges; triangles with two equal corners are in none.
std::vector<Part> partsOf(const InstanceTriangles& source) {
  struct Use {
    std::size_t triangle;
    bool upwards;
  };
  std::map<std::pair<int, int>, std::vector<Use>> edges;
  std::vector<std::size_t> parents(source.vertices.size());
  std::iota(parents.begin(), parents.end(), std::size_t{0});
  const auto find = [&](std::size_t t) {
    while (parents[t] != t) t = parents[t] = parents[parents[t]];
    return t;
  };
  const auto isDegenerate = [&](std::size_t t) {
    const auto& v = source.vertices[t];
    return v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
  };
  for (std::size_t t = 0; t < source.vertices.size(); ++t)
    for (std::size_t k = 0; k < 3 && !isDegenerate(t); ++k) {
      const int from = source.vertices[t][k], to = source.vertices[t][(k + 1) % 3];
      std::vector<Use>& uses = edges[std::minmax(from, to)];
      if (!uses.empty()) parents[find(t)] = find(uses.front().triangle);
      uses.push_back({t, from < to});
    }
  std::map<std::size_t, Part> parts;
  for (std::size_t t = 0; t < source.vertices.size(); ++t)
    if (!isDegenerate(t)) parts[find(t)].triangles.push_back(t);
  for (auto& [root, part] : parts) part.isClosed = true;
  for (const auto& [ends, uses] : edges)
    if (uses.size() != 2 || uses[0].upwards == uses[1].upwards) parts[find(uses[0].triangle)].isClosed = false;
  std::vector<Part> result;
  for (auto& [root, part] : parts) {
    const glm::dvec3 restOrigin = source.rest[root][0], origin = source.world[root][0];
    double rest = 0, posed = 0, areas = 0, size = 0;
    for (const std::size_t t : part.triangles) {
      rest += sixVolumes(source.rest[t], restOrigin), posed += sixVolumes(source.world[t], origin);
      areas += area(source.rest[t]);
      for (const glm::dvec3& p : source.rest[t]) size = std::max(size, glm::distance(p, restOrigin));
    }
    part.isClosed = part.isClosed && std::abs(rest) / 6 > 1e-6 * areas * size;
    part.isTurned = rest * posed < 0;
    result.push_back(std::move(part));
  }
  return result;
}

/// Triangles behind the bakers' queries, in a space of about 1 around them.
class Surface {
public:
  Surface(const std::vector<Corners>& triangles, std::vector<int> nodes) {
    glm::dvec3 min(std::numeric_limits<double>::infinity()), max(-min);
    for (const Corners& corners : triangles)
      for (const glm::dvec3& p : corners) min = glm::min(min, p), max = glm::max(max, p);
    soup_.centerObject = 0.5 * (min + max);
    soup_.unitsPerMetre = std::exp2(-std::ceil(std::log2(std::max(0.5 * glm::distance(min, max), 1e-30))));
    double six = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (!(area(triangles[t]) > 0)) continue;
      const auto first = static_cast<std::uint32_t>(soup_.positions.size());
      for (const glm::dvec3& p : triangles[t]) {
        soup_.positions.push_back(soup_.soupFromObject(p));
        soup_.reach = std::max(soup_.reach, glm::length(soup_.positions.back()));
        soup_.boundsObject.extend(glm::vec3(p));
      }
      soup_.triangles.push_back({first, first + 1, first + 2});
      nodes_.push_back(nodes[t]);
      six += sixVolumes(triangles[t], soup_.centerObject);
    }
    isInverted_ = six < 0;
    if (soup_.triangles.empty()) return;
    std::vector<std::uint32_t> all(soup_.triangles.size());
    std::iota(all.begin(), all.end(), 0u);
    hierarchy_ = std::make_unique<MeshHierarchy>(soup_, std::move(all));
    distance_ = std::make_unique<MeshDistance>(*hierarchy_);
    winding_ = std::make_unique<WindingNumber>(*hierarchy_);
  }
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    glm::dvec3 pointWorld{0};
    int node = -1;
  };
  Nearest nearest(glm::dvec3 point, double limit) const {
    if (!distance_) return {};
    const ClosestTriangle closest = distance_->closest(soup_.soupFromObject(point), limit * soup_.unitsPerMetre);
    if (closest.triangle == kNoTriangle) return {};
    return {closest.distance / soup_.unitsPerMetre, closest.on.point / soup_.unitsPerMetre + soup_.centerObject,
            nodes_[closest.triangle]};
  }
  /// A part that faces inwards encloses what lies around it.
  bool hasInside(glm::dvec3 point) const {
    if (!winding_) return false;
    const glm::dvec3 pointSoup = soup_.soupFromObject(point);
    if (glm::length(pointSoup) > soup_.reach) return isInverted_;
    return winding_->at(pointSoup) > (isInverted_ ? -0.5f : 0.5f);
  }
  std::size_t triangleCount() const { return soup_.triangles.size(); }

private:
  TriangleSoup soup_;
  std::vector<int> nodes_;
  bool isInverted_ = false;
  std::unique_ptr<MeshHierarchy> hierarchy_;
  std::unique_ptr<MeshDistance> distance_;
  std::unique_ptr<WindingNumber> winding_;
};

} // namespace

struct FieldOracle::Parts {
  std::vector<std::unique_ptr<Surface>> closed;
  std::unique_ptr<Surface> open;
};

FieldOracle::FieldOracle(const Scene& scene, const Pose& pose, const std::vector<int>& fieldOfNode)
    : parts_(std::make_unique<Parts>()) {
  std::vector<Corners> open;
  std::vector<int> openNodes;
  for (const PosedInstance& instance : pose.instances) {
    const auto node = static_cast<std::size_t>(instance.node);
    if (node < fieldOfNode.size() && fieldOfNode[node] >= 0) continue;
    const InstanceTriangles triangles = placeTriangles(scene, instance);
    for (const Part& part : partsOf(triangles)) {
      std::vector<Corners> placed;
      for (const std::size_t t : part.triangles) {
        placed.push_back(triangles.world[t]);
        if (part.isTurned) std::swap(placed.back()[1], placed.back()[2]);
      }
      const std::vector<int> nodes(placed.size(), instance.node);
      if (part.isClosed) {
        parts_->closed.push_back(std::make_unique<Surface>(placed, nodes));
      } else {
        open.insert(open.end(), placed.begin(), placed.end());
        openNodes.insert(openNodes.end(), nodes.begin(), nodes.end());
      }
    }
  }
  if (!open.empty()) parts_->open = std::make_unique<Surface>(open, openNodes);
}

FieldOracle::~FieldOracle() = default;
FieldOracle::FieldOracle(FieldOracle&&) noexcept = default;

double FieldOracle::thinningAt(glm::dvec3 pointWorld, const FieldTruth& truth, double texelMetres) const {
  const double share = 2 - truth.closedDistance / texelMetres;
  if (!(truth.closedDistance > 0) || !(share > (truth.insideClosed ? 1.5 : 0))) return 0;
  const auto nearestClosed = [&](glm::dvec3 point, bool& isInside) {
    Surface::Nearest nearest;
    for (const auto& part : parts_->closed) {
      const Surface::Nearest other = part->nearest(point, nearest.distance);
      if (!(other.distance < nearest.distance)) continue;
      nearest = other;
      isInside = part->hasInside(point);
    }
    return nearest;
  };
  bool isInside = false;
  const glm::dvec3 place = nearestClosed(pointWorld, isInside).pointWorld;
  const glm::dvec3 outwards = glm::normalize(truth.insideClosed ? place - pointWorld : pointWorld - place);
  const glm::dvec3 behind = place - texelMetres * outwards;
  const Surface::Nearest back = nearestClosed(behind, isInside);
  if (isInside || !(back.distance > 0) || glm::dot(behind - back.pointWorld, outwards) > -0.3 * back.distance) return 0;
  return 0.5 * std::min(share, 1.0) * std::min(back.distance, texelMetres);
}

FieldTruth FieldOracle::at(glm::dvec3 pointWorld, double texelMetres) const {
  FieldTruth truth;
  if (parts_->open) {
    const Surface::Nearest nearest = parts_->open->nearest(pointWorld, std::numeric_limits<double>::infinity());
    truth.openDistance = nearest.distance;
    truth.node = nearest.node;
  }
  for (const auto& part : parts_->closed) {
    const bool isInside = part->hasInside(pointWorld);
    truth.insideAny = truth.insideAny || isInside;
    const Surface::Nearest nearest = part->nearest(pointWorld, truth.closedDistance);
    if (!(nearest.distance < truth.closedDistance)) continue;
    truth.closedDistance = nearest.distance;
    truth.insideClosed = isInside;
    if (nearest.distance <= truth.openDistance) truth.node = nearest.node;
  }
  if (texelMetres > 0) truth.thinning = thinningAt(pointWorld, truth, texelMetres);
  return truth;
}

bool FieldOracle::seesBuriedSurface(glm::dvec3 pointWorld, double reach, double behind) const {
  const auto isHeld = [&](glm::dvec3 point) {
    return std::any_of(parts_->closed.begin(), parts_->closed.end(),
                       [&](const auto& part) { return part->hasInside(point); });
  };
  if (!isHeld(pointWorld)) return false;
  return std::any_of(parts_->closed.begin(), parts_->closed.end(), [&](const auto& part) {
    const Surface::Nearest nearest = part->nearest(pointWorld, reach);
    if (nearest.node < 0 || nearest.distance == 0) return false;
    return isHeld(nearest.pointWorld + behind / nearest.distance * (nearest.pointWorld - pointWorld));
  });
}

std::vector<FieldTruth> FieldOracle::at(std::span<const glm::dvec3> pointsWorld,
                                        std::span<const double> texelMetres) const {
  std::vector<FieldTruth> truths(pointsWorld.size());
  tbb::parallel_for(std::size_t{0}, truths.size(),
                    [&](std::size_t i) { truths[i] = at(pointsWorld[i], texelMetres.empty() ? 0 : texelMetres[i]); });
  return truths;
}

std::size_t FieldOracle::closedParts() const { return parts_->closed.size(); }
std::size_t FieldOracle::closedTriangles() const {
  std::size_t sum = 0;
  for (const auto& part : parts_->closed) sum += part->triangleCount();
  return sum;
}
std::size_t FieldOracle::openTriangles() const { return parts_->open ? parts_->open->triangleCount() : 0; }

} // namespace brickfield

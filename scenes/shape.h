// A triangle mesh under construction: what the generators make and the glTF writer stores. Metres, +Y up, fronts
// counter-clockwise. Not the renderer's scene: this program shares no code with what it feeds.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/math.h"

namespace brickfield::scenes {

using Color8 = std::array<std::uint8_t, 4>;
using Joints8 = std::array<std::uint8_t, 4>;

/// Vertex arrays are empty or as long as `positions`.
struct Shape {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;   ///< unit
  std::vector<glm::vec2> uvs;       ///< TEXCOORD_0
  std::vector<glm::vec2> uvsSecond; ///< TEXCOORD_1
  std::vector<Color8> colors;       ///< COLOR_0, linear
  std::vector<Joints8> joints;
  std::vector<glm::vec4> jointWeights;   ///< sums to 1
  std::vector<glm::vec3> morphPositions; ///< offsets of the one morph target
  std::vector<glm::vec3> morphNormals;
  std::vector<std::uint32_t> indices;
};

/// Which sides of a grid meet. A pole is a whole row that is one point.
struct GridTopology {
  bool closedU = false;
  bool closedV = false;
  bool poleAtStart = false; ///< v = 0
  bool poleAtEnd = false;   ///< v = 1
};

/// Samples a surface on (uCells + 1) x (vCells + 1) points over the unit square and joins them; the front is where
/// dP/du x dP/dv points. Rows and columns that meet carry exactly equal positions, triangles without area are left out.
/// uv = (u, v); normals are not made.
Shape gridShape(int uCells, int vCells, GridTopology topology,
                const std::function<glm::vec3(float u, float v)>& position);

/// Gives every corner the area-weighted mean of the faces around its position that lie within creaseDegrees of its own
/// face, and splits vertices where corners differ. Positions count as one where their bits are equal.
void smoothNormals(Shape& shape, float creaseDegrees);

/// Turns all triangles over if the enclosed signed volume is negative. Call it on closed shapes, before the normals.
void orientOutward(Shape& shape);
void flipTriangles(Shape& shape);

/// Signed volume that the triangles enclose; for a closed shape the true one.
double signedVolume(const Shape& shape);

/// Adds another shape. Optional arrays must be present in both or in neither.
void append(Shape& shape, const Shape& other);

/// Moves positions, normals and morph offsets; a mirroring transform turns the triangles over.
void transform(Shape& shape, const glm::mat4& destinationFromShape);

/// One colour, or one that depends on the place, for every vertex; linear in [0,1].
void paint(Shape& shape, glm::vec3 colorLinear);
void paint(Shape& shape, const std::function<glm::vec3(glm::vec3 position)>& colorLinear);

} // namespace brickfield::scenes

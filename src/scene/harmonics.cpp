// Irradiance as nine coefficients of real spherical harmonics: Ramamoorthi and Hanrahan, "An Efficient Representation
// for Irradiance Environment Maps", 2001. Order: Y00, Y1-1, Y10, Y11, Y2-2, Y2-1, Y20, Y21, Y22 with the paper's axes.
#include <numbers>

#include "scene/environment.h"

namespace brickfield {

namespace {

template <typename Vector>
std::array<typename Vector::value_type, 9> harmonicBasis(Vector d) {
  using Real = typename Vector::value_type;
  // sqrt(1/4π), sqrt(3/4π), sqrt(15/4π), sqrt(5/16π), sqrt(15/16π)
  constexpr auto k0 = static_cast<Real>(0.28209479177387814), k1 = static_cast<Real>(0.4886025119029199),
                 k2 = static_cast<Real>(1.0925484305920792), k20 = static_cast<Real>(0.31539156525252005),
                 k22 = static_cast<Real>(0.5462742152960396);
  return {k0,
          k1 * d.y,
          k1 * d.z,
          k1 * d.x,
          k2 * d.x * d.y,
          k2 * d.y * d.z,
          k20 * (Real{3} * d.z * d.z - Real{1}),
          k2 * d.x * d.z,
          k22 * (d.x * d.x - d.y * d.y)};
}

} // namespace

std::array<glm::vec3, 9> irradianceHarmonics(const Environment& environment) {
  std::array<glm::dvec3, 9> sums{};
  for (std::uint32_t row = 0; row < environment.size.y; ++row) {
    const double solidAngle = texelSolidAngle(environment.size, row);
    for (std::uint32_t column = 0; column < environment.size.x; ++column) {
      const glm::dvec2 uv((column + 0.5) / environment.size.x, (row + 0.5) / environment.size.y);
      const glm::dvec3 radiance(environment.radiance[std::size_t{row} * environment.size.x + column]);
      const std::array<double, 9> basis = harmonicBasis(environmentDirection(uv));
      for (std::size_t i = 0; i < 9; ++i) sums[i] += solidAngle * basis[i] * radiance;
    }
  }
  // The clamped cosine's own coefficients: π, 2π/3, π/4 for the bands 0, 1, 2.
  constexpr double kPi = std::numbers::pi;
  std::array<glm::vec3, 9> harmonics;
  for (std::size_t i = 0; i < 9; ++i)
    harmonics[i] = glm::vec3(sums[i] * (i == 0 ? kPi : i < 4 ? 2.0 * kPi / 3.0 : kPi / 4.0));
  return harmonics;
}

glm::vec3 evaluateHarmonics(const std::array<glm::vec3, 9>& harmonics, glm::vec3 directionWorld) {
  const std::array<float, 9> basis = harmonicBasis(directionWorld);
  glm::vec3 value(0.0f);
  for (std::size_t i = 0; i < 9; ++i) value += basis[i] * harmonics[i];
  return value;
}

} // namespace brickfield

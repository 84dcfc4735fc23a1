// In the order in which they are printed.
#include "app/shadow_methods.h"

#include "app/field_shadow_choice.h"

namespace brickfield {

const std::vector<BenchedShadows>& benchedShadows() {
  static const std::vector<BenchedShadows> methods = [] {
    std::vector<BenchedShadows> made;
    ShadowSettings rays;
    rays.method = ShadowMethod::Field;
    rays.penumbraRays = kChosenRays;
    const auto add = [&](const char* name, const char* meaning, FieldMethod field, ShadowSettings settings,
                         bool wantsBricks = false) {
      made.push_back({name, meaning, field, field == FieldMethod::Rtsdf ? 2 : 1, wantsBricks, settings});
    };
    const auto addMaps = [&](const char* name, const char* meaning, ShadowFilter filter) {
      ShadowSettings settings;
      settings.method = ShadowMethod::Maps;
      add(name, meaning, FieldMethod::Off, settings);
      made.back().maps.filter = filter;
    };
    const auto with = [&](ShadowEstimator estimator, int count) {
      ShadowSettings settings = rays;
      settings.estimator = estimator;
      settings.penumbraRays = count;
      return settings;
    };
    const auto exact = FieldMethod::Exact;
    ShadowSettings half = rays;
    half.halfResolution = true;
    add("field", "a cone, 10 rays, exact world field and meshes' bricks", exact, rays, true);
    add("field-half", "the same at half resolution", exact, half, true);
    add("field-16", "16 rays", exact, with(ShadowEstimator::Rays, 16), true);
    add("field-4", "4 rays", exact, with(ShadowEstimator::Rays, 4), true);
    add("field-alone", "10 rays, the world field alone", exact, rays);
    add("field-alone-half", "the same at half resolution", exact, half);
    ShadowSettings both = rays;
    both.method = ShadowMethod::MapsAndField;
    add("csm+field", "shadow maps of 2048 texels, then as field where they are unsure", exact, both, true);
    add("csm+field-alone", "the same without bricks", exact, both);
    addMaps("csm-pcf", "shadow maps of 2048 texels, three of them filtered", ShadowFilter::Pcf);
    addMaps("csm-evsm", "the same, exponential variances blurred over 15 texels", ShadowFilter::Evsm);
    add("rtsdf", "RTSDF's estimator on RTSDF's field, without its bias", FieldMethod::Rtsdf,
        with(ShadowEstimator::Rtsdf, 1));
    add("rtsdf-exact", "RTSDF's estimator on the exact field", exact, with(ShadowEstimator::Rtsdf, 1));
    add("umbra-exact", "RTSDF's simulated umbra, 16 rays, on the exact field", exact, with(ShadowEstimator::Umbra, 16));
    add("min-ratio", "the least k d / t on the exact field", exact, with(ShadowEstimator::MinRatio, 1));
    add("coverage", "signed march with disk coverage on the exact field", exact, with(ShadowEstimator::Coverage, 1));
    add("hard", "one ray to the light's middle on the exact field", exact, with(ShadowEstimator::Hard, 1));
    return made;
  }();
  return methods;
}

const BenchedShadows* findBenchedShadows(const std::string& name) {
  for (const BenchedShadows& method : benchedShadows())
    if (method.name == name) return &method;
  return nullptr;
}

} // namespace brickfield

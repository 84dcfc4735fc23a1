// One cone through the world field and, with BRICKS_ON, beside surfaces the bricks of objects: how free it is where it is
// touched most, and of whom. A cone that ends on something is not free at all; one that passes is as free as the nearest surface is
// far, in widths of it.
#include "lib/near_bricks.glsl"
#include "lib/shadow_cone.glsl"

const int MOST_REFLECTION_READS = 96, MOST_LIGHT_READS = 32;
const float REFLECTION_LIFT_GRAINS = 1.25, REFLECTION_FADE_GRAINS = 12.0, REFLECTION_LEAST_STEP_GRAINS = 0.25;
// As near as this the ray has met it; no cone is narrower than that of a mirror, in which nothing is sharper.
const float MET_GRAINS = 0.05, LEAST_CONE_GRAINS = 0.2;
// Over its own plane a cone rises by its cosine; as wide as this part of it, the plane never reaches into it.
const float REFLECTION_CLEAR = 0.5;

uint reflectionReads = 0u; // of this thread

struct ReflectionRay {
  vec3 origin; // anchored; on the surface
  vec3 normal; // of the surface, unit
  vec3 direction;
  float spread; // metres of width a metre of way
  float grain;  // of what is read at the origin
};

struct ReflectionReading {
  float distanceWorld; // metres, negative inside
  float grain;         // metres: nothing in it is finer
};

struct ReflectionMet {
  float free;
  float t;
  vec3 point; // anchored; of the ray
  float distanceWorld;
  float grain;
};

ReflectionReading readForReflection(vec3 pointAnchored, float fineMetres) {
  ++reflectionReads;
  FieldReading reading = readWorldField(pointAnchored);
  float texel = texelOf(reading);
#ifdef BRICKS_ON
  NearDistance refined = refineByBricks(pointAnchored, reading, texel, fineMetres);
  reflectionReads += refined.reads;
  return ReflectionReading(refined.distanceWorld, refined.grain);
#else
  return ReflectionReading(reading.distanceWorld, texel);
#endif
}

// Whether a distance is no more than the range or the border of the coarsest window let it be: then nothing is there.
bool isCutOff(vec3 pointAnchored, float metres) {
  int last = int(field.counts.x) - 1;
  FieldCascade coarsest = field.cascades[last];
  return isFieldCut(coarsest, metres * coarsest.texel.y, fieldDepth(last, pointAnchored * coarsest.texel.y));
}

ReflectionMet traceReflection(ReflectionRay ray) {
  ReflectionMet met = ReflectionMet(1.0, 0.0, ray.origin, 0.0, ray.grain);
  float spread = min(ray.spread, REFLECTION_CLEAR * max(dot(ray.normal, ray.direction), 0.0));
  float t = 0.0, end = leavesField(ray.origin, ray.direction, 0.0);
  for (int i = 0; i < MOST_REFLECTION_READS && t < end; ++i) {
    float lift = REFLECTION_LIFT_GRAINS * ray.grain * max(1.0 - t / (REFLECTION_FADE_GRAINS * ray.grain), 0.0);
    vec3 at = ray.origin + lift * ray.normal + t * ray.direction;
    ReflectionReading near = readForReflection(at, spread * t);
    bool isMet = near.distanceWorld <= MET_GRAINS * near.grain;
    float free = isMet ? 0.0 : near.distanceWorld / max(spread * t, LEAST_CONE_GRAINS * near.grain);
    if (free < met.free && !isCutOff(at, near.distanceWorld)) met = ReflectionMet(free, t, at, near.distanceWorld, near.grain);
    if (isMet) break;
    t += max(near.distanceWorld, REFLECTION_LEAST_STEP_GRAINS * near.grain);
  }
  return met;
}

// Outwards from what was met; towards the viewer of it where nothing tells.
vec3 normalOfMet(ReflectionMet met, vec3 direction) {
  vec3 gradient;
  float h = 0.5 * met.grain;
  for (int axis = 0; axis < 3; ++axis) {
    vec3 offset = vec3(axis == 0, axis == 1, axis == 2) * h;
    gradient[axis] = readForReflection(met.point + offset, 0.0).distanceWorld - readForReflection(met.point - offset, 0.0).distanceWorld;
  }
  return dot(gradient, gradient) > 0.0 ? normalize(gradient) : -direction;
}

// Number + 1 of the node that is nearest, of the finest cascade that knows one; 0: none does.
uint nearestNode(vec3 pointAnchored) {
  for (int c = 0; c < int(field.counts.x); ++c) {
    FieldCascade cascade = field.cascades[c];
    vec3 lattice = pointAnchored * cascade.texel.y;
    if (!isHeldByField(fieldDepth(c, lattice))) continue;
    uint node = worldFieldNodes[texelWord(cascade, ivec3(floor(lattice)))] & FIELD_NODE_MASK;
    if (node != 0u) return node;
  }
  return 0u;
}

// Whether light comes from a direction, from as far as `end` metres; by the field alone.
float seesLight(vec3 pointAnchored, vec3 normal, vec3 toLight, float end) {
  if (dot(normal, toLight) <= 0.0) return 0.0;
  float grain = texelOf(readWorldField(pointAnchored)), t = 0.0;
  end = min(end, leavesField(pointAnchored, toLight, 0.0));
  for (int i = 0; i < MOST_LIGHT_READS && t < end; ++i) {
    float lift = 1.5 * grain * max(1.0 - t / (8.0 * grain), 0.0);
    FieldReading reading = readWorldField(pointAnchored + lift * normal + t * toLight);
    ++reflectionReads;
    if (reading.distanceWorld <= MET_GRAINS * texelOf(reading)) return 0.0;
    t += max(reading.distanceWorld, 0.5 * texelOf(reading));
  }
  return 1.0;
}

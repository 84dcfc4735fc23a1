// The normals of a rough surface as a viewer sees them (Heitz 2018): twin of scene/visible_normals.h, whose words hold
// here too. In the space whose z is the surface's normal.
vec3 visibleNormal(float alpha, vec3 viewer, vec2 square) {
  vec3 drawn = normalize(vec3(alpha * viewer.xy, viewer.z));
  vec3 right = dot(drawn.xy, drawn.xy) > 0.0 ? normalize(vec3(-drawn.y, drawn.x, 0.0)) : vec3(0.0, 1.0, 0.0);
  float radius = sqrt(square.x), angle = radians(360.0) * (square.y - 0.25), share = 0.5 * (1.0 + drawn.z);
  float x = radius * cos(angle);
  float y = mix(sqrt(max(1.0 - x * x, 0.0)), radius * sin(angle), share);
  vec3 onSphere = x * right + y * cross(drawn, right) + sqrt(max(1.0 - x * x - y * y, 0.0)) * drawn;
  return normalize(vec3(alpha * onSphere.xy, max(onSphere.z, 0.0)));
}

// Smith's lambda: how much of a rough surface hides behind itself.
float smithLambda(float alpha, float cosine) {
  float square = cosine * cosine;
  return 0.5 * (sqrt(1.0 + alpha * alpha * (1.0 - square) / square) - 1.0);
}

float smithShadowing(float alpha, float nDotV, float nDotL) {
  float ofViewer = 1.0 + smithLambda(alpha, nDotV);
  return ofViewer / (ofViewer + smithLambda(alpha, nDotL));
}

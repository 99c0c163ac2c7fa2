// Outputs of surface_vertex.glsl and mouth_vertex.glsl to surface_fragment.glsl; this text precedes both.
uniform vec3 wrap;           // how far light wraps around, per channel
uniform float saturation;
uniform vec3 lobes;          // strengths of a broad, a middle and a tight highlight
uniform float bump;          // depth of pores or threads
uniform float chroma;        // saturation on the screen, below 1 beside a faded photo
uniform float detail_per_mm;  // repeats of the detail textures per millimetre; 0: by skin uv
uniform vec3 head_up;        // unit, the direction of growing v on the skin

out vec2 detail_uv;  // texture coordinate of the detail
out vec3 light;   // all scattered light, with the surface's colour
out vec4 slopes;  // change of light by a slope to the right and up; slopes of the half vector
out vec3 shine;   // strength of highlights, depth of creases, light at the edge
// In software a uniform costs each pixel more than a flat varying.
flat out vec4 finish;  // strengths of the highlights, depth of detail
flat out vec4 gleam;   // light for highlights; chroma

vec3 Albedo() {
  vec3 albedo = albedo_openness.rgb;
  return max(mix(vec3(dot(albedo, vec3(0.3, 0.6, 0.1))), albedo, saturation), 0.0);
}

// `power`: key light as a fraction of all light; `h`: half vector of key light and viewer.
void SetSlopes(vec3 n, vec3 h, float power) {
  vec3 right = normalize(cross(head_up, n) + vec3(1e-5, 0.0, 0.0));
  vec3 up = cross(n, right);
  slopes.xy = -power * vec2(dot(right, lamp_directions[0]), dot(up, lamp_directions[0]) + 0.12);
  slopes.zw = vec2(dot(right, h), dot(up, h));
  finish = vec4(lobes, bump);
  gleam = vec4(lamp_colours[0], chroma);
}

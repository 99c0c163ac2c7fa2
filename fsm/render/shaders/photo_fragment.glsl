// The photo includes its own light: it is shown as it is, except for creases that the face makes now. kCreased and
// kDetailed precede this text and follow SkinDetail; detailed skin is creased, too.
in vec2 detail_uv;
in vec3 texcoord;
in vec3 paint;
in vec4 grain_from;
in float crease;
in float shadow;
in float covering;
flat in vec3 settings;  // brightness, cut_out, blends

uniform sampler2D base_colour;
uniform sampler2D relief;

out vec4 colour;

void main() {
  vec4 p = texture(base_colour, texcoord.xy);
  float opacity = kDetailed ? covering * mix(1.0, p.a, settings.y) : 1.0;
  if (kDetailed && opacity < 0.98 && 1.0 - opacity > mix(OpacityStep(gl_FragCoord.xy), 0.99, settings.z)) discard;
  float shade = 1.0;
  if (kCreased) {
    vec2 slope = texture(relief, detail_uv).zw - 0.5;
    // Alpha is the share of skin in the skin's map: hair over skin does not crease.
    float furrow = look_photo_crease + look_photo_crease_slope * dot(slope, vec2(-0.5, 0.85));
    shade = 1.0 - p.a * clamp(crease, 0.0, 1.0) * furrow;
    // Furrows are visible by their shadows; their rims hardly shine.
    if (shade > 1.0) shade = mix(1.0, shade, look_photo_crease_rim);
    shade = clamp(shade, look_photo_crease_range.x, look_photo_crease_range.y);
  }
  vec3 painted = paint;
  if (kDetailed && grain_from.z > 0.0) {
    float grain = dot(texture(base_colour, grain_from.xy).rgb, vec3(0.3, 0.6, 0.1));
    float factor = clamp(grain / grain_from.w, look_photo_grain_range.x, look_photo_grain_range.y);
    painted *= mix(1.0, factor, look_photo_grain * grain_from.z);
  }
  vec3 seen = mix(painted, p.rgb, texcoord.z);
  // Light that reaches shaded skin has passed through skin.
  float skin = look_photo_shade_redness * clamp(1.0 - seen.b / max(seen.r, 0.05), 0.0, 1.0);
  vec3 shaded = vec3(shadow) + skin * shadow * (1.0 - shadow) * vec3(1.0, 0.0, -0.4);
  colour = vec4(seen * shade * shaded * settings.x, mix(1.0, opacity, settings.z));
}

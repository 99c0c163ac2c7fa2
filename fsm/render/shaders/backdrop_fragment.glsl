in vec2 view_uv;
uniform sampler2D picture;
uniform bool pictured;
uniform bool studio;
uniform float wide;     // aspect ratio of the view, width / height
uniform vec3 plain;     // the colour without picture and studio
uniform float opacity;  // over what has been drawn already
out vec4 colour;

vec3 Wall() {
  float away = length((view_uv - look_studio_middle) * vec2(wide, 1.0)) / look_studio_radius;
  // Dither by a level of noise, without which the eye sees the steps between levels of a screen.
  float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  return mix(look_studio_dark, look_studio_bright, exp(-away * away)) + (noise - 0.5) / 255.0;
}

// All colours are screen colours (sRGB) already.
void main() {
  vec3 behind = pictured ? texture(picture, view_uv).rgb : studio ? Wall() : plain;
  colour = vec4(behind, opacity);
}

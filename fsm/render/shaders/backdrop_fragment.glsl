in vec2 place;
uniform sampler2D picture;
uniform bool pictured;
uniform bool studio;
uniform float wide;     // width of the view, 1 = its height
uniform vec3 plain;     // the colour where there is neither picture nor studio
uniform float opacity;  // over what is drawn already
out vec4 colour;

vec3 Wall() {
  float away = length((place - look_studio_middle) * vec2(wide, 1.0)) / look_studio_radius;
  // Without noise of a level the eye sees where one level of a screen ends and the next begins.
  float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  return mix(look_studio_dark, look_studio_bright, exp(-away * away)) + (noise - 0.5) / 255.0;
}

// Colours are screen colours already.
void main() {
  vec3 behind = pictured ? texture(picture, place).rgb : studio ? Wall() : plain;
  colour = vec4(behind, opacity);
}

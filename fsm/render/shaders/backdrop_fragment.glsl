#version 330 core
in vec2 place;
uniform sampler2D picture;
uniform bool pictured;
uniform vec3 plain;     // the colour where there is no picture
uniform float opacity;  // over what is drawn already
out vec4 colour;
// Picture and colour are in screen colours already.
void main() { colour = vec4(pictured ? texture(picture, place).rgb : plain, opacity); }

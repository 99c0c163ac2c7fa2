#version 330 core
in vec2 place;
uniform sampler2D picture;
out vec4 color;
// The picture is in screen colours already.
void main() { color = vec4(texture(picture, place).rgb, 1.0); }

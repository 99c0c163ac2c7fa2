// How skin creases with expression, for the vertex shaders of skin; transform.glsl stands before it.
layout(location = 5) in vec4 creases;        // how much each shows here
layout(location = 6) in vec2 nose_and_left;  // that of the nose; to which part the left side creases

uniform vec4 crease_depths[2];  // right, left: forehead, glabella, crow's feet, nasolabial
uniform float nose_creases[2];

float CreaseDepth() {
  return dot(creases, mix(crease_depths[0], crease_depths[1], nose_and_left.y)) +
         nose_and_left.x * mix(nose_creases[0], nose_creases[1], nose_and_left.y);
}

// Creases of expression for the vertex shaders of skin; transform.glsl precedes it.
layout(location = kDetail) in vec4 creases;        // weight of each crease at this vertex
layout(location = kDetailMore) in vec2 nose_and_left;  // weight of the nose's crease; part of the left side in the depth

uniform vec4 crease_depths[2];  // right, left; by crease: forehead, glabella, crow's feet, nasolabial
uniform float nose_creases[2];

float CreaseDepth() {
  return dot(creases, mix(crease_depths[0], crease_depths[1], nose_and_left.y)) +
         nose_and_left.x * mix(nose_creases[0], nose_creases[1], nose_and_left.y);
}

// Creases of expression for the vertex shaders of skin; transform.glsl precedes it.
layout(location = kDetail) in vec4 creases;        // weight of each crease at this vertex
layout(location = kDetailMore) in vec3 more_creases;  // weights of nose and sides of the forehead; part of the left side in the depth

uniform vec4 crease_depths[2];  // right, left; by crease: forehead, glabella, crow's feet, nasolabial
uniform vec2 more_crease_depths[2];  // nose, sides of the forehead

float CreaseDepth() {
  float left = more_creases.z;
  return dot(creases, mix(crease_depths[0], crease_depths[1], left)) +
         dot(more_creases.xy, mix(more_crease_depths[0], more_crease_depths[1], left));
}

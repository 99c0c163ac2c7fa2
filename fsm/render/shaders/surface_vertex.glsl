// Skin, lips, teeth, gums, tongue, the inside of the mouth, cloth. Light that changes slowly is worked
// out here and not per pixel: the mesh is so fine that a software rasterizer shades several pixels
// beside every triangle for each one in it.
uniform vec3 wrap;           // how far light goes round, per channel
uniform float key_through;   // how much of the key light reaches occluded places all the same
uniform float sheen;         // down that catches light at the edges
uniform float saturation;

out vec3 world_normal;
out vec3 half_way;    // between the key light and the viewer
out vec3 rest;
out vec3 soft_light;  // everything but the key light, with the surface's colour
out vec3 key_light;   // the key light before its angle, with the surface's colour
out float gloss;

void main() {
  vec3 world = Place();
  vec3 n = WorldNormal();
  vec3 v = normalize(eye - world);
  float occlusion = albedo_occlusion.a;
  vec3 albedo = albedo_occlusion.rgb;
  albedo = max(mix(vec3(dot(albedo, vec3(0.3, 0.6, 0.1))), albedo, saturation), 0.0);

  // Corners shut off from light glow red, because what light there is came through skin.
  float root = sqrt(occlusion);
  vec3 open = vec3(1.0, sqrt(root), root) * occlusion;
  vec3 shadow = vec3(KeyShadow(world));
  shadow.gb *= shadow.gb * 0.3 + 0.7;

  vec3 soft = Ambient(n) + kFillColor * Wrapped(dot(n, kFillDirection), wrap) +
              kRimColor * 0.5 * Wrapped(dot(n, kRimDirection), wrap * 0.6);
  float g = max(dot(n, normalize(kFillDirection + v)), 0.0);
  float g4 = g * g * g * g;
  float away = 1.0 - max(dot(n, v), 0.0);
  vec3 mirrored = kFillColor * (0.03 * g4 * g4 * g4 * g4) +
                  (kRimColor * 0.10 + Ambient(n) * 0.12) * (away * away * away);
  half_way = normalize(key_direction + v);

  world_normal = n;
  rest = rest_position;
  soft_light = albedo * open * soft + mirrored * (occlusion * occlusion * sheen);
  key_light = albedo * kKeyColor * shadow * mix(open, vec3(1.0), key_through);
  gloss = Fresnel(dot(half_way, v)) * occlusion * occlusion * shadow.g *
          clamp(dot(n, key_direction) * 4.0 + 0.2, 0.0, 1.0);
}

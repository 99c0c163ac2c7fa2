// What wears a photo: skin, lips, and the sheet of hair, neck and clothes.
layout(location = 4) in vec2 unrolled;
layout(location = 7) in vec4 photo_texcoord;  // u, v down; the photo's part in the colour; how much is lid
layout(location = 8) in vec4 lid_grain;   // of a lid: the place whose grain it takes; its way
layout(location = 9) in float opacity;     // 1: hides what is behind, 0: is not there
layout(location = 10) in vec3 rest_normal;  // as long as the light on it follows it, 0..1
layout(location = 11) in vec2 lid_skin;     // 1: of a lid, else 0; how bright the skin is whose grain it takes

uniform float lids_shut[2];  // right, left
uniform float chin_y;         // of its lowest point at rest, millimetres
uniform float chin_drop;      // how far it is below that
uniform bool ragged;          // the sheet, of which what is transparent in the photo is left out
uniform float brightness;
uniform bool blends;          // in part, over what is drawn already; else sample by sample
uniform vec4 photo_light;     // in the head's frame: on a normal, and from all sides
uniform mat3 rest_to_world;   // how the head is turned, with the figure's scale
uniform float lips_apart;    // 0: closed, where the photo shows them so; 1: as they are without it
uniform bool lashes;         // seen on shut lids; those of open ones are in the photo
uniform float yields;        // millimetres by which it lies behind what is as near

out vec2 place;
out vec3 texcoord;
out vec3 paint;
out vec4 grain_from;  // place, whether there is one, how bright it is round it
out float crease;
out float shadow;
out float covering;
flat out vec3 settings;  // brightness, ragged, blends (1 or 0): in software a uniform costs a pixel more

void main() {
  vec3 world = TransformVertex();
  if (yields > 0.0) {
    vec4 farther = world_to_clip * vec4(world + yields * normalize(world - eye), 1.0);
    gl_Position.z = farther.z / farther.w * gl_Position.w;
  }
  settings = vec3(brightness, float(ragged), float(blends));
  place = unrolled;
  float lid = photo_texcoord.w;
  float closed = rest_position.x < 0.0 ? lids_shut[0] : lids_shut[1];
  // The rim of the lower lid, which has no way to go, is reached last.
  float shut = lid_grain.zw == vec2(0.0) ? Ramp(look_photo_lower_lid_shuts, closed)
                                           : Ramp(look_photo_lid_shuts, closed);
  texcoord = vec3(photo_texcoord.xy + closed * lid_grain.zw, photo_texcoord.z * (1.0 - lid * shut));
  bool of_lid = lid_skin.x > 0.5;
  grain_from = of_lid ? vec4(lid_grain.xy, 1.0, lid_skin.y) : vec4(photo_texcoord.xy, 0.0, 1.0);
  // A lip that rolls inward is paint in part, and the more so as it turns away.
  float roll = Ramp(look_photo_lip_roll, 1.0 - photo_texcoord.z);
  float facing = Ramp(look_photo_lip_facing, dot(WorldNormal(), normalize(eye - world)));
  texcoord.z *= mix(1.0, facing, roll);
  if (photo_texcoord.z > 0.0 && roll > 0.0) texcoord.z = mix(1.0, texcoord.z, lips_apart);
  // The shadow that a dropped chin throws on the neck, which goes with it.
  float below = chin_y + look_chin_shadow_rise * rest_position.x * rest_position.x - rest_position.y;
  shadow = 1.0 - look_chin_shadow * float(ragged) * Ramp(look_chin_shadow_drop, chin_drop) *
                     Ramp(look_chin_shadow_edge, below) * exp(-max(below, 0.0) / look_chin_shadow_fades) *
                     Ramp(look_chin_shadow_sides, abs(rest_position.x));
  // The photo has the light on the face at rest; what turns with an expression is lit as it faces then
  // (an expression ratio image, Liu, Shan and Zhang 2001).
  float follows = length(rest_normal);
  if (follows > 0.0) {
    vec3 n = normalize(transpose(rest_to_world) * WorldNormal());
    vec2 light = vec2(dot(photo_light.xyz, n), dot(photo_light.xyz, rest_normal / follows)) + photo_light.w;
    light = max(light, look_photo_light_least * (length(photo_light.xyz) + abs(photo_light.w)));
    float change = sqrt(light.x / light.y) - 1.0;
    shadow *= 1.0 + follows * change / (1.0 + look_photo_light_held * abs(change));
  }
  covering = opacity * (lashes ? Ramp(look_photo_lashes_shut, closed) : 1.0);
  // The sheet shows what is beside the face.
  crease = ragged ? 0.0 : CreaseDepth();
  paint = sqrt(max(albedo_openness.rgb * (of_lid ? 1.0 : albedo_openness.a), 0.0)) *
          mix(1.0, mix(look_photo_lip_away, 1.0, facing), roll);
}

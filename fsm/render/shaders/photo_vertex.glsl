// Parts that wear a photo: skin, lips, and the sheet of hair, neck and clothes.
layout(location = kDetailTexcoord) in vec2 unrolled;
layout(location = kTexcoord) in vec4 photo_texcoord;  // u, v down; weight of the photo; weight of the lid
layout(location = kLidGrain) in vec4 lid_grain;   // of a lid: the texture coordinate of its grain; its slide
layout(location = kOpacity) in float opacity;     // 1 = opaque, 0 = absent
layout(location = kRelitNormal) in vec3 rest_normal;  // its length, 0..1, is how much the light follows it
layout(location = kLidSkin) in vec2 lid_skin;     // 1 on a lid, else 0; mean brightness around its grain

uniform float lids_shut[2];  // right, left
uniform float chin_y;         // y of the chin's lowest point at rest, millimetres
uniform float chin_drop;      // how far it has dropped, millimetres
uniform bool cut_out;          // the sheet, which is discarded where the photo is transparent
uniform float brightness;
uniform bool blends;          // alpha-blended over earlier layers; else alpha to coverage
uniform vec4 photo_light;     // in the head's frame: directional part, ambient part
uniform mat3 rest_to_world;   // rotation of the head, with the figure's scale
uniform float lips_apart;    // 0: closed, as the photo shows them; 1: as without a photo
uniform bool lashes;         // visible on shut lids; the photo shows those of open ones
uniform float depth_offset_mm;  // away from the eye, so that other surfaces win

out vec2 detail_uv;
out vec3 texcoord;
out vec3 paint;
out vec4 grain_from;  // texture coordinate, whether there is one, mean brightness around it
out float crease;
out float shadow;
out float covering;
flat out vec3 settings;  // brightness, cut_out, blends (1 or 0): in software a uniform costs each pixel more

void main() {
  vec3 world = TransformVertex();
  if (depth_offset_mm > 0.0) {
    vec4 farther = world_to_clip * vec4(world + depth_offset_mm * normalize(world - eye), 1.0);
    gl_Position.z = farther.z / farther.w * gl_Position.w;
  }
  settings = vec3(brightness, float(cut_out), float(blends));
  detail_uv = unrolled;
  float lid = photo_texcoord.w;
  float closed = rest_position.x < 0.0 ? lids_shut[0] : lids_shut[1];
  // The margin of the lower lid, which does not slide, is reached last.
  float shut = lid_grain.zw == vec2(0.0) ? Ramp(look_photo_lower_lid_shuts, closed)
                                           : Ramp(look_photo_lid_shuts, closed);
  texcoord = vec3(photo_texcoord.xy + closed * lid_grain.zw, photo_texcoord.z * (1.0 - lid * shut));
  bool of_lid = lid_skin.x > 0.5;
  grain_from = of_lid ? vec4(lid_grain.xy, 1.0, lid_skin.y) : vec4(photo_texcoord.xy, 0.0, 1.0);
  // A lip that rolls inward is partly painted, and more so as it turns away.
  float roll = Ramp(look_photo_lip_roll, 1.0 - photo_texcoord.z);
  float facing = Ramp(look_photo_lip_facing, dot(WorldNormal(), normalize(eye - world)));
  texcoord.z *= mix(1.0, facing, roll);
  if (photo_texcoord.z > 0.0 && roll > 0.0) texcoord.z = mix(1.0, texcoord.z, lips_apart);
  // The shadow that a dropped chin casts on the neck and that moves with it.
  float below = chin_y + look_chin_shadow_rise * rest_position.x * rest_position.x - rest_position.y;
  shadow = 1.0 - look_chin_shadow * float(cut_out) * Ramp(look_chin_shadow_drop, chin_drop) *
                     Ramp(look_chin_shadow_edge, below) * exp(-max(below, 0.0) / look_chin_shadow_fades) *
                     Ramp(look_chin_shadow_sides, abs(rest_position.x));
  // The photo includes the light on the face at rest; a surface that an expression turns is relit by its new normal
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
  // The sheet shows what surrounds the face.
  crease = cut_out ? 0.0 : CreaseDepth();
  paint = sqrt(max(albedo_openness.rgb * (of_lid ? 1.0 : albedo_openness.a), 0.0)) *
          mix(1.0, mix(look_photo_lip_away, 1.0, facing), roll);
}

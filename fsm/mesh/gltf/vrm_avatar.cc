#include "fsm/mesh/gltf/vrm_avatar.h"

#include <nlohmann/json.hpp>

#include "fsm/mesh/imported_head.h"

namespace fsm {
namespace {

using nlohmann::json;

/// Reads a range in degrees; leaves `out` unchanged if a number is not a valid angle.
void ReadRange(const json& range, const char* from, const char* to, GazeRange& out) {
  const double gaze = JsonNumber(range, from, -1), output = JsonNumber(range, to, -1);
  if (gaze <= 0 || gaze > 360 || output < 0 || output > 360) return;
  out = {static_cast<float>(gaze), static_cast<float>(output)};
}

void ReadVrm0(const json& vrm, VrmAvatar& avatar) {
  avatar.faces_minus_z = true;
  for (const json& bone : JsonMember(JsonMember(vrm, "humanoid"), "humanBones")) {
    const std::string name = JsonText(bone, "bone");
    if (name == "rightEye") avatar.eye_bone.right = JsonInteger(bone, "node");
    if (name == "leftEye") avatar.eye_bone.left = JsonInteger(bone, "node");
  }
  const json& person = JsonMember(vrm, "firstPerson");
  GazeRanges ranges;
  avatar.gaze_by_shape = JsonText(person, "lookAtTypeName") == "BlendShape";
  for (const auto& [key, range] : {std::pair("lookAtHorizontalInner", &ranges.inner),
                                   {"lookAtHorizontalOuter", &ranges.outer},
                                   {"lookAtVerticalDown", &ranges.down},
                                   {"lookAtVerticalUp", &ranges.up}}) {
    ReadRange(JsonMember(person, key), "xRange", "yRange", *range);
  }
  if (person.contains("lookAtTypeName")) avatar.gaze_ranges = ranges;
  for (const json& group : JsonMember(JsonMember(vrm, "blendShapeMaster"), "blendShapeGroups")) {
    VrmAvatar::Expression expression{JsonText(group, "presetName"), {}};
    if (expression.name.empty() || expression.name == "unknown") {
      expression.name = JsonText(group, "name");
    }
    for (const json& bind : JsonMember(group, "binds")) {
      expression.binds.push_back({JsonInteger(bind, "mesh"), -1, JsonInteger(bind, "index"),
                                  JsonNumber(bind, "weight", 0) / 100});
    }
    avatar.expressions.push_back(std::move(expression));
  }
}

void ReadVrm1(const GltfDocument& document, const json& vrm, VrmAvatar& avatar) {
  const json& bones = JsonMember(JsonMember(vrm, "humanoid"), "humanBones");
  avatar.eye_bone = {JsonInteger(JsonMember(bones, "rightEye"), "node"),
                     JsonInteger(JsonMember(bones, "leftEye"), "node")};
  const json& look = JsonMember(vrm, "lookAt");
  GazeRanges ranges;
  avatar.gaze_by_shape = JsonText(look, "type") == "expression";
  for (const auto& [key, range] : {std::pair("rangeMapHorizontalInner", &ranges.inner),
                                   {"rangeMapHorizontalOuter", &ranges.outer},
                                   {"rangeMapVerticalDown", &ranges.down},
                                   {"rangeMapVerticalUp", &ranges.up}}) {
    ReadRange(JsonMember(look, key), "inputMaxValue", "outputScale", *range);
  }
  if (look.contains("type")) avatar.gaze_ranges = ranges;
  for (const char* kind : {"preset", "custom"}) {
    const json& given = JsonMember(JsonMember(vrm, "expressions"), kind);
    if (!given.is_object()) continue;
    for (const auto& [name, of] : given.items()) {
      VrmAvatar::Expression expression{name, {}};
      for (const json& bind : JsonMember(of, "morphTargetBinds")) {
        const std::int64_t node = JsonInteger(bind, "node");
        expression.binds.push_back({JsonInteger(document.At("nodes", node), "mesh"), node,
                                    JsonInteger(bind, "index"), JsonNumber(bind, "weight", 0)});
      }
      avatar.expressions.push_back(std::move(expression));
    }
  }
}

/// Finds eye bones by names such as "LeftEye", "Eye_L" or "mixamorig:RightEye".
void FindByName(const GltfDocument& document, VrmAvatar& avatar) {
  for (std::size_t s = 0; s < document.Count("skins"); ++s) {
    const json& skin = document.At("skins", static_cast<std::int64_t>(s));
    for (const std::int64_t node : JsonIntegers(skin, "joints")) {
      const std::string name = PlainShapeName(JsonText(document.At("nodes", node), "name"));
      if (name.ends_with("righteye") || name.ends_with("eyeright")) avatar.eye_bone.right = node;
      if (name.ends_with("lefteye") || name.ends_with("eyeleft")) avatar.eye_bone.left = node;
    }
  }
}

}  // namespace

VrmAvatar ReadVrm(const GltfDocument& document) {
  VrmAvatar avatar;
  const json& extensions = JsonMember(document.root(), "extensions");
  if (extensions.contains("VRMC_vrm")) {
    ReadVrm1(document, JsonMember(extensions, "VRMC_vrm"), avatar);
  } else if (extensions.contains("VRM")) {
    ReadVrm0(JsonMember(extensions, "VRM"), avatar);
  } else {
    FindByName(document, avatar);
  }
  return avatar;
}

}  // namespace fsm

#include "fsm/mesh/vrm_avatar.h"

#include <nlohmann/json.hpp>

#include "fsm/mesh/head_file.h"

namespace fsm {
namespace {

using nlohmann::json;

/// Degrees; what is no angle of an eye is left as it was.
void Take(const json& range, const char* from, const char* to, LookRange& out) {
  const double gaze = RealOf(range, from, -1), turn = RealOf(range, to, -1);
  if (gaze <= 0 || gaze > 360 || turn < 0 || turn > 360) return;
  out = {static_cast<float>(gaze), static_cast<float>(turn)};
}

void ReadOld(const json& vrm, VrmAvatar& avatar) {
  avatar.looks_back = true;
  for (const json& bone : PartOf(PartOf(vrm, "humanoid"), "humanBones")) {
    const std::string name = TextOf(bone, "bone");
    if (name == "rightEye") avatar.eye_bone.right = WholeOf(bone, "node");
    if (name == "leftEye") avatar.eye_bone.left = WholeOf(bone, "node");
  }
  const json& person = PartOf(vrm, "firstPerson");
  avatar.says_look = person.contains("lookAtTypeName");
  avatar.look_by_shape = TextOf(person, "lookAtTypeName") == "BlendShape";
  for (const auto& [key, range] : {std::pair("lookAtHorizontalInner", &avatar.look.inner),
                                   {"lookAtHorizontalOuter", &avatar.look.outer},
                                   {"lookAtVerticalDown", &avatar.look.down},
                                   {"lookAtVerticalUp", &avatar.look.up}}) {
    Take(PartOf(person, key), "xRange", "yRange", *range);
  }
  for (const json& group : PartOf(PartOf(vrm, "blendShapeMaster"), "blendShapeGroups")) {
    VrmAvatar::Expression expression{TextOf(group, "presetName"), {}};
    if (expression.name.empty() || expression.name == "unknown") {
      expression.name = TextOf(group, "name");
    }
    for (const json& bind : PartOf(group, "binds")) {
      expression.binds.push_back(
          {WholeOf(bind, "mesh"), -1, WholeOf(bind, "index"), RealOf(bind, "weight", 0) / 100});
    }
    avatar.expressions.push_back(std::move(expression));
  }
}

void ReadNew(const GltfDocument& document, const json& vrm, VrmAvatar& avatar) {
  const json& bones = PartOf(PartOf(vrm, "humanoid"), "humanBones");
  avatar.eye_bone = {WholeOf(PartOf(bones, "rightEye"), "node"),
                     WholeOf(PartOf(bones, "leftEye"), "node")};
  const json& look = PartOf(vrm, "lookAt");
  avatar.says_look = look.contains("type");
  avatar.look_by_shape = TextOf(look, "type") == "expression";
  for (const auto& [key, range] : {std::pair("rangeMapHorizontalInner", &avatar.look.inner),
                                   {"rangeMapHorizontalOuter", &avatar.look.outer},
                                   {"rangeMapVerticalDown", &avatar.look.down},
                                   {"rangeMapVerticalUp", &avatar.look.up}}) {
    Take(PartOf(look, key), "inputMaxValue", "outputScale", *range);
  }
  for (const char* kind : {"preset", "custom"}) {
    const json& given = PartOf(PartOf(vrm, "expressions"), kind);
    if (!given.is_object()) continue;
    for (const auto& [name, of] : given.items()) {
      VrmAvatar::Expression expression{name, {}};
      for (const json& bind : PartOf(of, "morphTargetBinds")) {
        const std::int64_t node = WholeOf(bind, "node");
        expression.binds.push_back({WholeOf(document.At("nodes", node), "mesh"), node,
                                    WholeOf(bind, "index"), RealOf(bind, "weight", 0)});
      }
      avatar.expressions.push_back(std::move(expression));
    }
  }
}

/// Bones called "LeftEye", "Eye_L", "mixamorig:RightEye" and the like.
void FindByName(const GltfDocument& document, VrmAvatar& avatar) {
  for (std::size_t s = 0; s < document.Count("skins"); ++s) {
    const json& skin = document.At("skins", static_cast<std::int64_t>(s));
    for (const std::int64_t node : WholesOf(skin, "joints")) {
      const std::string name = PlainShapeName(TextOf(document.At("nodes", node), "name"));
      if (name.ends_with("righteye") || name.ends_with("eyeright")) avatar.eye_bone.right = node;
      if (name.ends_with("lefteye") || name.ends_with("eyeleft")) avatar.eye_bone.left = node;
    }
  }
}

}  // namespace

VrmAvatar ReadVrm(const GltfDocument& document) {
  VrmAvatar avatar;
  const json& extensions = PartOf(document.root(), "extensions");
  if (extensions.contains("VRMC_vrm")) {
    ReadNew(document, PartOf(extensions, "VRMC_vrm"), avatar);
  } else if (extensions.contains("VRM")) {
    ReadOld(PartOf(extensions, "VRM"), avatar);
  } else {
    FindByName(document, avatar);
  }
  return avatar;
}

}  // namespace fsm

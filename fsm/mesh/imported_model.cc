#include "fsm/mesh/imported_model.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>

#include "fsm/base/box.h"
#include "fsm/base/smooth_step.h"
#include "fsm/head/identity.h"
#include "fsm/mesh/part_names.h"
#include "fsm/mesh/texture_atlas.h"
#include "fsm/rig/reach.h"

namespace fsm {
namespace {

/// Returns, for each vertex, the number of its connected component.
std::vector<std::uint32_t> Pieces(std::size_t count, std::span<const std::uint32_t> indices) {
  std::vector<std::uint32_t> parent(count);
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    parent[root(indices[i])] = root(indices[i + 1]);
    parent[root(indices[i + 1])] = root(indices[i + 2]);
  }
  for (std::uint32_t v = 0; v < count; ++v) parent[v] = root(v);
  return parent;
}

class HeadBuilder {
 public:
  HeadBuilder(const ImportedHead& file, const Similarity& to_ours, float mouth_y)
      : file_(file), to_ours_(to_ours), mouth_y_(mouth_y) {
    model_.name = file.name;
    for (const glm::vec3& p : file.position) {
      at_.push_back(to_ours(p));
      if (!WithinReach(at_.back())) Refuse("vertex " + std::to_string(at_.size() - 1));
    }
  }

  MeshModel Build() {
    for (const Image& picture : file_.pictures) atlas_.Add(picture);
    model_.textures.image = atlas_.Make();
    if (model_.textures.image) LayDetails();
    model_.has_uv_seams = !file_.texcoord.empty();
    for (const glm::vec3& p : at_) {
      // The neck bends below the chin, as that of the built-in heads.
      model_.Add(p, Bone::kSkin, BasePalette().skin, {}, NeckWeight(p));
    }
    HangSprings();
    FindEyes();
    for (const auto& part : file_.parts) AddPart(part);
    return std::move(model_);
  }

 private:
  void LayDetails() {
    std::vector<Image> normal_maps, emissive_map;
    for (const auto& detail : file_.details) {
      normal_maps.push_back(detail.normal_map);
      emissive_map.push_back(detail.emissive_map);
    }
    model_.textures.normal_map = atlas_.MakeBeside(std::move(normal_maps), {128, 128, 255, 255});
    model_.textures.emissive_map = atlas_.MakeBeside(std::move(emissive_map), {255, 255, 255, 255});
  }

  static float NeckWeight(glm::vec3 p) { return SmoothStep(-168, -96, p.y); }

  /// Copies the springs of the head; those of the body, which does not rotate, are left out.
  void HangSprings() {
    constexpr glm::vec3 kAxis{0, 0, -14};  // x and z of the axis of head and neck
    std::vector<std::int64_t> number;
    for (Spring spring : file_.spring_rig.springs) {
      spring.rest = to_ours_(spring.rest);
      spring.root = to_ours_(spring.root);
      spring.most_mm *= to_ours_.scale;
      if (spring.outward != glm::vec3(0)) {
        const glm::vec3 beside = (spring.rest - kAxis) * glm::vec3(1, 0, 1);
        spring.outward = glm::normalize(beside + glm::vec3(0, 0, 1e-3f));
      }
      const bool of_head = WithinReach(spring.rest) && WithinReach(spring.root) &&
                           NeckWeight(spring.root) > 0.5f && spring.most_mm >= Spring::kLeastMost &&
                           spring.most_mm <= Spring::kMostMost;
      number.push_back(of_head ? static_cast<std::int64_t>(model_.spring_rig.springs.size()) : -1);
      if (of_head) model_.spring_rig.springs.push_back(spring);
    }
    for (SpringWeight weight : file_.spring_rig.weights) {
      const std::int64_t spring = number[weight.spring];
      if (spring < 0) continue;
      weight.spring = static_cast<std::uint32_t>(spring);
      model_.spring_rig.weights.push_back(weight);
    }
  }

  [[noreturn]] void Refuse(const std::string& what) const {
    constexpr float kMmInKm = 1e6F;
    throw std::runtime_error(file_.name + ": " + what + " comes to lie farther than " +
                             std::to_string(static_cast<int>(kMaxReach / kMmInKm)) +
                             " km from the head: do its landmarks "
                             "(.points) or eyes belong to it?");
  }

  static PartKind KindOf(const ImportedHead::Part& part) {
    return PartNames::BuiltIn().KindOf(part.name);
  }

  /// Finds the eyes: parts with such names, or vertices that the file's skeleton assigns to eyes.
  void FindEyes() {
    Sided<Box> box;
    eye_.assign(at_.size(), std::nullopt);
    for (const auto& part : file_.parts) {
      const bool is_eye = KindOf(part) == PartKind::kEye;
      for (const std::uint32_t v : part.indices) {
        if (!file_.eye.empty() ? !file_.eye[v] : !is_eye) continue;
        const Side side = at_[v].x < 0 ? Side::kRight : Side::kLeft;
        eye_[v] = side;
        box[side].Add(at_[v]);
      }
    }
    if (box.right.empty() || box.left.empty()) return;
    for (const Side side : kSides) {
      const glm::vec3 radii = box[side].radii();
      EyeGeometry& eye = model_.eyes[side];
      eye.ball_radius = std::max(0.5f * (radii.x + radii.y), 1e-6f);
      // Some files have only the front half of an eyeball.
      eye.centre = box[side].centre();
      eye.centre.z = box[side].high.z - eye.ball_radius;
      eye.iris_radius = 0.5f * eye.ball_radius;
      eye.iris_colour = BasePalette().iris;
    }
    model_.has_eyes = std::ranges::all_of(
        kSides, [this](Side side) { return model_.eyes[side].ball_radius < 40; });
    model_.eye_setup.gaze_ranges = file_.eye_setup.gaze_ranges;
    if (file_.eye_setup.pivot) {
      model_.eye_setup.pivot.emplace();
      for (const Side side : kSides) {
        glm::vec3& pivot = (*model_.eye_setup.pivot)[side];
        pivot = to_ours_((*file_.eye_setup.pivot)[side]);
        if (!WithinReach(pivot)) Refuse("what an eye turns about");
      }
    }
    for (const Side side : kSides) {
      // The eye of a drawn figure is a disc that rotates about a point deep in the head.
      if (box[side].radii().z < 0.4f * model_.eyes[side].ball_radius) model_.round_eyes = false;
    }
  }

  void AddPart(const ImportedHead::Part& part) {
    const PartKind kind = KindOf(part);
    const bool pictured = part.picture >= 0 && !file_.texcoord.empty();
    if (kind == PartKind::kEye && !pictured && model_.has_eyes) {
      AddEyeballs();
      return;
    }
    const auto pieces = kind == PartKind::kTeeth || kind == PartKind::kGum
                            ? Pieces(at_.size(), part.indices)
                            : std::vector<std::uint32_t>();
    std::vector<Box> piece(pieces.empty() ? 0 : at_.size());
    if (!pieces.empty()) {
      for (const std::uint32_t v : part.indices) piece[pieces[v]].Add(at_[v]);
    }
    for (const std::uint32_t v : part.indices) {
      model_.mesh.bone[v] = BoneOfPart(kind, v, pieces.empty() ? nullptr : &piece[pieces[v]]);
      model_.mesh.albedo[v] = ColourOf(kind, part, v);
      if (!pictured) continue;
      const glm::vec2 uv = file_.texcoord[v];
      const glm::vec2 within(Wrapped(uv.x), Wrapped(uv.y));
      model_.textures.texcoord[v] = atlas_.rect(static_cast<std::size_t>(part.picture)).At(within);
      model_.textures.weight[v] = 1;
    }
    const int pbr = PbrOf(kind, part, pictured);
    if (pbr >= 0) {
      for (const std::uint32_t v : part.indices) {
        // The picture already has the colour, so only the tint is applied.
        const glm::vec3 tint = file_.vertex_colour.empty() ? glm::vec3(1) : file_.vertex_colour[v];
        model_.mesh.albedo[v] = pictured ? tint : tint * part.colour;
      }
    }
    const Material material = MaterialOf(kind, pictured, part.cut_out);
    auto& indices = model_.mesh.BatchOf(material, pbr, part.two_sided).indices;
    indices.insert(indices.end(), part.indices.begin(),
                   part.indices.begin() + static_cast<std::ptrdiff_t>(part.indices.size() / 3 * 3));
  }

  /// Returns the model's index of the part's PbrMaterial. Without pictures, skin and mouth are lit
  /// as those of the built-in heads, unless they are toon-shaded.
  int PbrOf(PartKind kind, const ImportedHead::Part& part, bool pictured) {
    if (part.pbr < 0) return -1;
    const PbrMaterial& pbr = file_.pbr_materials[static_cast<std::size_t>(part.pbr)];
    const bool own =
        kind == PartKind::kHair || kind == PartKind::kOther || model_.textures.image != nullptr;
    if (!pictured && !own && pbr.kind == PbrMaterial::Kind::kLit) return -1;
    const auto [known, fresh] =
        pbr_index_.try_emplace(part.pbr, static_cast<int>(model_.pbr_materials.size()));
    if (fresh) model_.pbr_materials.push_back(pbr);
    return known->second;
  }

  static float Wrapped(float x) { return x >= 0 && x <= 1 ? x : x - std::floor(x); }

  Bone BoneOfPart(PartKind kind, std::uint32_t v, const Box* piece) const {
    if (eye_[v] && model_.has_eyes) return BoneOf(*eye_[v]);
    switch (kind) {
      case PartKind::kTeeth:
      case PartKind::kGum:
        return (piece ? piece->centre().y : at_[v].y) > mouth_y_ ? Bone::kSkull : Bone::kJaw;
      case PartKind::kTongue:
        return Bone::kJaw;
      case PartKind::kHair:
      case PartKind::kOther:
        return Bone::kSkull;
      default:
        return Bone::kSkin;
    }
  }

  glm::vec3 ColourOf(PartKind kind, const ImportedHead::Part& part, std::uint32_t v) const {
    const Palette& palette = BasePalette();
    if (!file_.vertex_colour.empty() && file_.vertex_colour[v] != glm::vec3(1))
      return part.colour * file_.vertex_colour[v];
    switch (kind) {
      case PartKind::kTeeth:
        return palette.tooth;
      case PartKind::kGum:
        return palette.gum;
      case PartKind::kTongue:
        return palette.tongue;
      case PartKind::kMouth:
        return palette.mouth;
      case PartKind::kLash:
        return palette.lash;
      default:
        return part.colour;
    }
  }

  Material MaterialOf(PartKind kind, bool pictured, bool cut_out) const {
    if (pictured) return cut_out ? Material::kPhoto : Material::kSkin;
    switch (kind) {
      case PartKind::kTeeth:
        return Material::kTeeth;
      case PartKind::kGum:
        return Material::kGum;
      case PartKind::kTongue:
        return Material::kTongue;
      case PartKind::kMouth:
        return Material::kMouthInside;
      case PartKind::kLash:
        return Material::kMatte;
      default:
        // Material::kSkin would show the picture.
        return model_.textures.image ? Material::kMatte : Material::kSkin;
    }
  }

  /// Adds our own eyeballs, once for both sides, because helper spheres have no iris.
  void AddEyeballs() {
    if (eyeballs_added_) return;
    eyeballs_added_ = true;
    for (const Side side : kSides) {
      model_.eyes[side].iris_radius = 5.9f;
      model_.AddEyeball(side);
    }
  }

  const ImportedHead& file_;
  const Similarity& to_ours_;
  float mouth_y_;
  std::vector<glm::vec3> at_;
  std::vector<std::optional<Side>> eye_;  // by vertex
  TextureAtlas atlas_;
  std::map<int, int> pbr_index_;  // file's index -> model's index of a material
  MeshModel model_;
  bool eyeballs_added_ = false;
};

}  // namespace

MeshModel ModelOfImport(const ImportedHead& file, const Similarity& to_ours, float mouth_y) {
  return HeadBuilder(file, to_ours, mouth_y).Build();
}

}  // namespace fsm

#include "fsm/mesh/align_imported_head.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "fsm/base/box.h"
#include "fsm/head/identity.h"
#include "fsm/head/mesh_builder.h"
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

[[noreturn]] void Refuse(const ImportedHead& file, const std::string& what) {
  throw std::runtime_error(file.name + ": " + what + " comes to lie farther than " +
                           kMaxReachOfHead +
                           " from the head: do its landmarks (.points) or eyes belong to it?");
}

/// Copies the springs of the head; those of the body, which does not rotate, are left out.
SpringRig SpringsOfHead(const SpringRig& file, const Similarity& to_ours) {
  constexpr glm::vec3 kAxis{0, 0, -14};  // x and z of the axis of head and neck
  SpringRig rig;
  std::vector<std::int64_t> number;
  for (Spring spring : file.springs) {
    spring.rest = to_ours(spring.rest);
    spring.root = to_ours(spring.root);
    spring.reach_mm *= to_ours.scale;
    if (spring.outward != glm::vec3(0)) {
      const glm::vec3 beside = (spring.rest - kAxis) * glm::vec3(1, 0, 1);
      spring.outward = glm::normalize(beside + glm::vec3(0, 0, 1e-3f));
    }
    const bool of_head =
        WithinReach(spring.rest) && WithinReach(spring.root) && NeckWeight(spring.root.y) > 0.5f &&
        spring.reach_mm >= Spring::kMinReachMm && spring.reach_mm <= Spring::kMaxReachMm;
    number.push_back(of_head ? static_cast<std::int64_t>(rig.springs.size()) : -1);
    if (of_head) rig.springs.push_back(spring);
  }
  for (SpringWeight weight : file.weights) {
    const std::int64_t spring = number[weight.spring];
    if (spring < 0) continue;
    weight.spring = static_cast<std::uint32_t>(spring);
    rig.weights.push_back(weight);
  }
  return rig;
}

/// The eye that each vertex belongs to.
using EyeOfVertex = std::vector<std::optional<Side>>;

/// Finds the eyes of the model: parts with such names, or vertices that the file's skeleton assigns
/// to eyes. `at`: the vertices in our frame.
EyeOfVertex FindEyes(const ImportedHead& file, std::span<const glm::vec3> at,
                     const Similarity& to_ours, UnriggedHead& model) {
  Sided<Box> box;
  EyeOfVertex eye_of(at.size());
  for (const auto& part : file.parts) {
    const bool is_eye = PartNames::BuiltIn().KindOf(part.name) == PartKind::kEye;
    for (const std::uint32_t v : part.indices) {
      if (!file.eye.empty() ? !file.eye[v] : !is_eye) continue;
      const Side side = at[v].x < 0 ? Side::kRight : Side::kLeft;
      eye_of[v] = side;
      box[side].Add(at[v]);
    }
  }
  if (box.right.empty() || box.left.empty()) return eye_of;
  for (const Side side : kSides) {
    const glm::vec3 radii = box[side].radii();
    EyeGeometry& eye = model.eyes[side];
    eye.ball_radius = std::max(0.5f * (radii.x + radii.y), 1e-6f);
    // Some files have only the front half of an eyeball.
    glm::vec3& centre = model.eye_rig.centre[side] = box[side].centre();
    centre.z = box[side].high.z - eye.ball_radius;
    eye.iris_radius = 0.5f * eye.ball_radius;
    eye.iris_colour = BasePalette().iris;
    // The eye of a drawn figure is a disc that rotates about a point deep in the head.
    if (radii.z < 0.4f * eye.ball_radius) model.round_eyes = false;
  }
  model.has_eyes = model.eyes.right.ball_radius < 40 && model.eyes.left.ball_radius < 40;
  model.eye_rig.gaze_ranges = file.eye_rig.gaze_ranges;
  if (auto& pivots = model.eye_rig.pivot = file.eye_rig.pivot) {
    for (glm::vec3* const pivot : {&pivots->right, &pivots->left}) {
      *pivot = to_ours(*pivot);
      if (!WithinReach(*pivot)) Refuse(file, "what an eye turns about");
    }
  }
  return eye_of;
}

/// What a part without pictures becomes.
struct PartLook {
  Bone above, below;                 ///< above and below the mouth
  glm::vec3 Palette::*colour;        ///< null: the file's
  std::optional<Material> material;  ///< none: skin, unless the head has pictures
};

PartLook LookOf(PartKind kind) {
  static constexpr std::array<PartLook, 9> kLooks{{
      // by PartKind
      {Bone::kSkin, Bone::kSkin, nullptr, {}},                              // skin
      {Bone::kSkin, Bone::kSkin, nullptr, {}},                              // eye
      {Bone::kSkull, Bone::kJaw, &Palette::tooth, Material::kTeeth},        // teeth
      {Bone::kSkull, Bone::kJaw, &Palette::gum, Material::kGum},            // gum
      {Bone::kJaw, Bone::kJaw, &Palette::tongue, Material::kTongue},        // tongue
      {Bone::kSkin, Bone::kSkin, &Palette::mouth, Material::kMouthInside},  // mouth
      {Bone::kSkull, Bone::kSkull, nullptr, {}},                            // hair
      {Bone::kSkin, Bone::kSkin, &Palette::lash, Material::kMatte},         // lash
      {Bone::kSkull, Bone::kSkull, nullptr, {}}                             // other
  }};
  return kLooks[static_cast<std::size_t>(kind)];
}

class HeadBuilder {
 public:
  HeadBuilder(const ImportedHead& file, const Similarity& to_ours, float mouth_y)
      : file_(file), to_ours_(to_ours), mouth_y_(mouth_y) {
    model_.name = file.name;
    for (const glm::vec3& p : file.position) {
      positions_.push_back(to_ours(p));
      if (!WithinReach(positions_.back()))
        Refuse(file, "vertex " + std::to_string(positions_.size() - 1));
    }
  }

  UnriggedHead Build() {
    for (const Image& picture : file_.base_colours) atlas_.Add(picture);
    model_.textures.base_colour = atlas_.Make();
    if (model_.textures.base_colour) LayDetails();
    model_.has_uv_seams = !file_.texcoord.empty();
    for (const glm::vec3& p : positions_) {
      // The neck bends below the chin, as that of the built-in heads.
      model_.Add(p, Bone::kSkin, BasePalette().skin, {}, NeckWeight(p.y));
    }
    model_.spring_rig = SpringsOfHead(file_.spring_rig, to_ours_);
    eye_of_ = FindEyes(file_, positions_, to_ours_, model_);
    for (const auto& part : file_.parts) AddPart(part);
    return std::move(model_);
  }

 private:
  void LayDetails() {
    std::vector<Image> normals, emission_openness;
    for (const auto& detail : file_.details) {
      normals.push_back(detail.normal_roughness_metal);
      emission_openness.push_back(detail.emission_openness);
    }
    model_.textures.normal_roughness_metal =
        atlas_.MakeBeside(std::move(normals), {128, 128, 255, 255});
    model_.textures.emission_openness =
        atlas_.MakeBeside(std::move(emission_openness), {255, 255, 255, 255});
  }

  void AddPart(const ImportedHead::Part& part) {
    const PartKind kind = PartNames::BuiltIn().KindOf(part.name);
    const PartLook look = LookOf(kind);
    const bool textured = part.base_colour >= 0 && !file_.texcoord.empty();
    if (kind == PartKind::kEye && !textured && model_.has_eyes) {
      AddEyeballs();
      return;
    }
    SetBones(part, look);
    for (const std::uint32_t v : part.indices) {
      const bool tinted = !file_.vertex_colour.empty() && file_.vertex_colour[v] != glm::vec3(1);
      model_.mesh.albedo[v] = tinted        ? part.colour * file_.vertex_colour[v]
                              : look.colour ? BasePalette().*look.colour
                                            : part.colour;
      if (!textured) continue;
      const glm::vec2 uv = file_.texcoord[v];
      const glm::vec2 within(Wrapped(uv.x), Wrapped(uv.y));
      model_.textures.texcoord[v] =
          atlas_.rect(static_cast<std::size_t>(part.base_colour)).At(within);
      model_.textures.weight[v] = 1;
    }
    const int pbr = PbrOf(kind, part, textured);
    if (pbr >= 0) {
      for (const std::uint32_t v : part.indices) {
        // The picture already has the colour, so only the tint is applied.
        const glm::vec3 tint = file_.vertex_colour.empty() ? glm::vec3(1) : file_.vertex_colour[v];
        model_.mesh.albedo[v] = textured ? tint : tint * part.colour;
      }
    }
    // Material::kSkin would show the head's picture.
    const Material plain = model_.textures.base_colour ? Material::kMatte : Material::kSkin;
    const Material material = textured ? part.cut_out ? Material::kTextured : Material::kSkin
                                       : look.material.value_or(plain);
    auto& indices = model_.mesh.BatchOf(material, pbr, part.two_sided).indices;
    indices.insert(indices.end(), part.indices.begin(),
                   part.indices.begin() + static_cast<std::ptrdiff_t>(part.indices.size() / 3 * 3));
  }

  /// Teeth and gums go with the jaw or with the skull by the place of each connected piece.
  void SetBones(const ImportedHead::Part& part, const PartLook& look) {
    std::vector<std::uint32_t> pieces;
    std::vector<Box> piece;
    if (look.above != look.below) {
      pieces = Pieces(positions_.size(), part.indices);
      piece.resize(positions_.size());
      for (const std::uint32_t v : part.indices) piece[pieces[v]].Add(positions_[v]);
    }
    for (const std::uint32_t v : part.indices) {
      const bool above = !pieces.empty() && piece[pieces[v]].centre().y > mouth_y_;
      model_.mesh.bone[v] = eye_of_[v] && model_.has_eyes ? BoneOf(*eye_of_[v])
                            : above                       ? look.above
                                                          : look.below;
    }
  }

  /// Returns the model's index of the part's PbrMaterial. Without pictures, skin and mouth are lit
  /// as those of the built-in heads, unless they are toon-shaded.
  int PbrOf(PartKind kind, const ImportedHead::Part& part, bool textured) {
    if (part.pbr < 0) return -1;
    const PbrMaterial& pbr = file_.pbr_materials[static_cast<std::size_t>(part.pbr)];
    const bool own = kind == PartKind::kHair || kind == PartKind::kOther ||
                     model_.textures.base_colour != nullptr;
    if (!textured && !own && pbr.kind == PbrMaterial::Kind::kLit) return -1;
    const auto [known, fresh] =
        pbr_index_.try_emplace(part.pbr, static_cast<int>(model_.pbr_materials.size()));
    if (fresh) model_.pbr_materials.push_back(pbr);
    return known->second;
  }

  static float Wrapped(float x) { return x >= 0 && x <= 1 ? x : x - std::floor(x); }

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
  std::vector<glm::vec3> positions_;
  EyeOfVertex eye_of_;
  TextureAtlas atlas_;
  std::map<int, int> pbr_index_;  // file's index -> model's index of a material
  UnriggedHead model_;
  bool eyeballs_added_ = false;
};

}  // namespace

UnriggedHead AlignImportedHead(const ImportedHead& file, const Similarity& to_ours, float mouth_y) {
  return HeadBuilder(file, to_ours, mouth_y).Build();
}

}  // namespace fsm

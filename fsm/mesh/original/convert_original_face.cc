#include "fsm/mesh/original/convert_original_face.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>

#include "fsm/base/box.h"
#include "fsm/base/pi.h"
#include "fsm/base/smooth_step.h"
#include "fsm/image/colour_space.h"
#include "fsm/mesh/original/original_points.h"
#include "fsm/mesh/texture_atlas.h"

namespace fsm {
namespace {

/// Builds the model part by part, in our frame.
class OriginalBuilder {
 public:
  explicit OriginalBuilder(const OriginalFace& face) : face_(face), space_(face.wireframe) {}

  UnriggedHead Build() {
    const std::size_t picture = atlas_.Add(face_.picture);
    std::size_t eye_picture = 0;
    if (face_.eye_picture) eye_picture = atlas_.Add(*face_.eye_picture);
    model_.textures.base_colour = atlas_.Make();
    AddFace(picture);
    AddMouth();
    AddEyes(eye_picture);
    AddSockets();
    if (face_.upper_teeth) AddTeeth(*face_.upper_teeth, Bone::kSkull);
    if (face_.lower_teeth) AddTeeth(*face_.lower_teeth, Bone::kJaw);
    NameLandmarks();
    return std::move(model_);
  }

 private:
  std::uint32_t Vertex(PointName name) const {
    return static_cast<std::uint32_t>(face_.wireframe.index.at(name));
  }
  glm::vec3 PositionOf(PointName name) const { return model_.mesh.position[Vertex(name)]; }

  void AddFace(std::size_t picture) {
    // The picture covers -1..1 of the wireframe at rest in both directions.
    const float chin = space_.PositionMm(face_.wireframe, kChin).y;
    for (const glm::vec3& p : face_.wireframe.positions) {
      const glm::vec2 texcoord =
          atlas_.rect(picture).At(glm::clamp(glm::vec2(p.x + 1, 1 - p.y) / 2.0f, 0.0f, 1.0f));
      const glm::vec3 at = space_.ToMm(p);
      model_.Add(at, Bone::kSkin, face_.mouth, texcoord, SmoothStep(chin - 42, chin - 4, at.y));
    }
    for (const auto& triangle : face_.link.triangles) {
      if (!IsDrawn(triangle.group)) continue;
      model_.mesh.Triangle(Material::kSkin, Vertex(triangle.corner[0]), Vertex(triangle.corner[1]),
                           Vertex(triangle.corner[2]));
    }
    for (const auto& [upper, lower] : kLipPairs) {
      model_.mouth.seam.emplace_back(Vertex(upper), Vertex(lower));
      ShutAtRest(model_.mesh.position[Vertex(upper)], model_.mesh.position[Vertex(lower)]);
    }
    model_.mouth.corners = {model_.mouth.seam.front().first, model_.mouth.seam.back().first};
  }

  /// Closes lips at rest: wireframes leave a gap or an overlap of less than a millimetre, through
  /// which teeth would be visible.
  static void ShutAtRest(glm::vec3& upper, glm::vec3& lower) {
    constexpr float kMaxGapMm = 0.8f;
    if (std::abs(upper.y - lower.y) > kMaxGapMm) return;
    const glm::vec2 middle = 0.5f * (glm::vec2(upper) + glm::vec2(lower));
    upper = glm::vec3(middle, upper.z);
    lower = glm::vec3(middle, lower.z);
  }

  /// Adds the inside of the mouth, a bag behind the rim of the lips: the upper half belongs to the
  /// skull, the lower half to the jaw.
  void AddMouth() {
    std::vector<std::uint32_t> rim;
    for (const PointName& name : kLipRim) rim.push_back(Vertex(name));
    const glm::vec3 middle = 0.5f * (PositionOf(kLipCorners.right) + PositionOf(kLipCorners.left));
    struct Ring {
      float back, high, wide;
    };
    constexpr Ring kRings[] = {{5, 9, 0.97f}, {25, 16, 0.95f}, {48, 12, 0.7f}};
    std::vector<std::uint32_t> outer = rim;
    for (const Ring& ring : kRings) {
      std::vector<std::uint32_t> inner;
      for (std::size_t i = 0; i < rim.size(); ++i) {
        const glm::vec3 p = model_.mesh.position[rim[i]];
        // Points 0 and 10 of the rim's 20 are the corners, 1 to 9 the upper lip.
        const float round = std::sin(kPi * static_cast<float>(i % 10) / 10);
        const float up = i < 10 ? round : -round;
        const glm::vec3 at(middle.x + (p.x - middle.x) * ring.wide, p.y + up * ring.high,
                           p.z - ring.back);
        inner.push_back(model_.Add(at, i <= 10 ? Bone::kSkull : Bone::kJaw,
                                   face_.mouth * (1 - 0.012f * ring.back)));
      }
      for (std::size_t i = 0; i < rim.size(); ++i) {
        const std::size_t j = (i + 1) % rim.size();
        model_.mesh.Triangle(Material::kMouthInside, outer[i], outer[j], inner[j]);
        model_.mesh.Triangle(Material::kMouthInside, outer[i], inner[j], inner[i]);
      }
      outer = std::move(inner);
    }
    const std::uint32_t end =
        model_.Add(middle - glm::vec3(0, 0, 55), Bone::kSkull, face_.mouth * 0.3f);
    for (std::size_t i = 0; i < outer.size(); ++i) {
      model_.mesh.Triangle(Material::kMouthInside, outer[i], outer[(i + 1) % outer.size()], end);
    }
  }

  void AddEyes(std::size_t picture) {
    model_.has_eyes = true;
    for (const Side side : kSides) {
      EyeGeometry& eye = model_.eyes[side];
      eye.iris_colour = {0.10f, 0.055f, 0.03f};
      if (face_.eye_def && face_.eye) {
        AddOwnEye(side, picture);
        continue;
      }
      model_.eye_rig.centre[side] =
          space_.EyeOpening(face_.wireframe, side) - glm::vec3(0, 0, 12.6f);
      eye.ball_radius = 12.4f;
      model_.AddEyeball(side);
    }
  }

  /// Adds the eyeball of the configuration, with its picture projected from the front.
  void AddOwnEye(Side side, std::size_t picture) {
    const EyeDef& def = *face_.eye_def;
    // Right and left follow from the positions, not from the order in the file.
    const bool right =
        (def.eye.right.position.x < def.eye.left.position.x) == (side == Side::kRight);
    const EyeDef::Eye& eye = right ? def.eye.right : def.eye.left;
    const glm::vec3 angles = glm::radians(eye.rotation_degrees);
    glm::mat4 rotation(1.0f);
    rotation = glm::rotate(rotation, angles.x, {1, 0, 0});
    rotation = glm::rotate(rotation, angles.y, {0, 1, 0});
    rotation = glm::rotate(rotation, angles.z, {0, 0, 1});
    const Box box = Box::Of(face_.eye->positions);
    const glm::vec3 size = glm::max(box.size(), 1e-6f), middle = box.centre();
    model_.eye_rig.centre[side] = space_.ToMm(eye.position);
    model_.eyes[side].ball_radius = 0.5f * size.x * eye.scale * space_.mm();
    model_.eyes[side].iris_radius = 0.48f * model_.eyes[side].ball_radius;
    const Bone carrier = BoneOf(side);
    const auto first = static_cast<std::uint32_t>(model_.mesh.position.size());
    for (const glm::vec3& p : face_.eye->positions) {
      const glm::vec2 flat = 0.5f + def.picture_scale * glm::vec2(p - middle) / glm::vec2(size);
      const glm::vec2 texcoord =
          atlas_.rect(picture).At(glm::clamp(glm::vec2(flat.x, 1 - flat.y), 0.0f, 1.0f));
      const glm::vec3 at = eye.position + eye.scale * glm::vec3(rotation * glm::vec4(p, 1));
      model_.Add(space_.ToMm(at), carrier, glm::vec3(0.5f), texcoord);
    }
    for (const auto& group : face_.eye->groups) {
      for (const auto& t : group.triangles) {
        model_.mesh.Triangle(Material::kTextured, first + t[0].position, first + t[1].position,
                             first + t[2].position);
      }
    }
  }

  /// Adds a surface behind each lid rim, so that nothing is visible past the eyeball.
  void AddSockets() {
    for (const Side side : kSides) {
      const glm::vec3 centre = model_.eye_rig.centre[side];
      std::vector<std::uint32_t> rim, back;
      for (const PointName& name : LidRim(side)) {
        rim.push_back(Vertex(name));
        const glm::vec3 p = PositionOf(name);
        back.push_back(model_.Add(
            {p.x + 0.15f * (p.x - centre.x), p.y + 0.3f * (p.y - centre.y), centre.z - 4},
            Bone::kSkull, {0.20f, 0.07f, 0.05f}));
      }
      for (std::size_t i = 0; i < rim.size(); ++i) {
        const std::size_t j = (i + 1) % rim.size();
        model_.mesh.Triangle(Material::kMouthInside, rim[i], rim[j], back[j]);
        model_.mesh.Triangle(Material::kMouthInside, rim[i], back[j], back[i]);
      }
    }
  }

  /// Adds a row of teeth, placed as in the original: an arch as wide as the jaw, each row as high
  /// as the space behind its lip, the front teeth at the depth of the corners of the mouth; the
  /// rows meet just above the edge of the upper lip. The original keeps the depth of the arch,
  /// which is not visible; here it is scaled with the width, so that the arch fits into narrow
  /// jaws.
  void AddTeeth(const ObjFile& teeth, Bone bone) {
    const auto at = [this](PointName name) {
      return face_.wireframe.positions[face_.wireframe.index.at(name)];
    };
    const bool upper = bone == Bone::kSkull;
    const TeethPoints& places = upper ? kUpperTeeth : kLowerTeeth;
    const Box box = Box::Of(teeth.positions);
    const glm::vec3 size = glm::max(box.size(), 1e-6f);
    const float wide = std::abs(at(kJawAtTeeth.left).x - at(kJawAtTeeth.right).x) / size.x;
    const float tall = std::abs(at(places.top).y - at(places.bottom).y) / size.y;
    const float edge = 0.5f * (at(kUpperLipFront).y + at(kLipMiddle).y);
    const glm::vec3 from(box.centre().x, upper ? box.low.y : box.high.y, box.high.z);
    const glm::vec3 to(at(kUpperLipFront).x, edge, at(places.front).z);
    const auto first = static_cast<std::uint32_t>(model_.mesh.position.size());
    for (const glm::vec3& p : teeth.positions) {
      const glm::vec3 place = to + glm::vec3(wide, tall, wide) * (p - from);
      model_.Add(space_.ToMm(place), bone, ShownTeeth());
    }
    for (const auto& group : teeth.groups) {
      for (const auto& t : group.triangles) {
        model_.mesh.Triangle(Material::kTeeth, first + t[0].position, first + t[1].position,
                             first + t[2].position);
      }
    }
  }

  /// Returns the linear colour that teeth have in the original: its lamp gives four fifths of their
  /// colour at three quarters of its distance, plus the ambient of GL's default material, in sRGB.
  glm::vec3 ShownTeeth() const {
    return SrgbToLinear(glm::min(0.8f / 0.75f * face_.teeth + 0.04f, 1.0f));
  }

  void NameLandmarks() {
    for (const auto& [name, point] : kNamedPoints) model_.landmarks[name] = PositionOf(point);
    model_.landmarks["stomion"] = 0.5f * (PositionOf(kLipMiddle) + PositionOf({1, 37}));
    const glm::vec3 middle = space_.ToMm(glm::vec3(0));
    model_.view = ParallelView{middle, space_.ToMm(glm::vec3(1, 0, 0)).x - middle.x};
  }

  const OriginalFace& face_;
  OriginalSpace space_;
  TextureAtlas atlas_;
  UnriggedHead model_;
};

}  // namespace

UnriggedHead ConvertOriginalFace(const OriginalFace& face) { return OriginalBuilder(face).Build(); }

}  // namespace fsm

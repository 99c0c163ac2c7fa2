#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "fsm/base/table_reader.h"
#include "fsm/head/features.h"
#include "fsm/rig/eye_transform.h"
#include "fsm/rig/unit_table.h"

namespace fsm {

/// Returns the names of the built-in faces (blocks of tables/identities.txt), the default one
/// first. Valid as long as the program runs.
const std::vector<std::string>& Identities();
bool IsBuiltIn(std::string_view name);

/// The colours of a head, linear RGB; see BasePalette.
struct Palette {
  glm::vec3 skin{}, blush{}, lip{}, hair{}, brow{}, lash{}, iris{}, cloth{}, tooth{}, sclera{};
  glm::vec3 lip_inside{}, lid_rim{}, mouth{}, tongue{}, gum{};
  float beard = 0;  ///< visibility of a shaved beard, 0..1
};

/// Returns the base head's colours: the rows of tables/identities.txt that precede all faces.
const Palette& BasePalette();

/// Short hair all around.
struct CropStyle {
  float side_mm, top_mm;  ///< thickness of the shell over the skin
  int locks;
  float lock_mm;   ///< length of a lock
  float lift_mm;   ///< height of a lock's tip over the shell
  float wave_mm;   ///< sideways swing of a lock
  float front_up;  ///< how far locks over the forehead stand up, 0..1
  float recede;    ///< degrees by which the hairline recedes at the temples
  float curl = 0;  ///< 0: hairs lie along the head; 1: tight curls that stand off it
};

/// Parted hair that hangs down.
struct LongStyle {
  float parting = 0.17f;  ///< to the agent's left, as a fraction of the hair's half width
  float full_mm = 0;      ///< additional thickness over the skull
  float front_y = -84;    ///< y of the ends beside the face, millimetres
  float back_y = -112;    ///< y of the ends behind
  float wave_mm = 2.2f;   ///< sideways swing of hanging hair
  float tucked = 0;       ///< 1: behind the ear on the agent's left
  /// y of the ends of a fringe over the middle of the face; none: the forehead is free.
  std::optional<float> fringe_y{};
};

/// Hair that is combed back from the whole hairline.
struct CombedStyle {
  float side_mm, top_mm;  ///< thickness over the skin
  int loose = 0;          ///< number of strands that hang at each temple
  /// Tied to a tail behind; none: short hair that ends at the nape.
  struct Tail {
    float tie_y, end_y;  ///< millimetres
  };
  std::optional<Tail> tail;
  float wave_mm = 0;  ///< swing of its waves
  float aside = 0;    ///< how far to the agent's left it is combed on top, -1..1
};

/// The differences of a face from the base head; a block of tables/identities.txt.
struct Identity {
  std::size_t index = 0;  ///< index in Identities()
  Palette palette = BasePalette();
  std::vector<std::pair<std::string, float>> sliders;
  std::variant<LongStyle, CropStyle, CombedStyle> hair;
  EyeTransform eyes;  ///< of the left eye; `shift` follows from the sliders
  /// The fold of the upper lid, relative to the base head's.
  struct LidFold {
    float inner_mm = 0, outer_mm = 0;  ///< additional height at the eye's two corners
    float dark = 1;                    ///< factor on its darkness
    float full_mm = 0;                 ///< additional thickness of the skin there and above
  };
  LidFold fold;
  float lashes = 1;
  struct Brows {
    float thickness = 1, height_mm = 0;
    float arch = 1;     ///< curvature: 0 = straight from end to end
    float density = 1;  ///< number of hairs, and darkness of the skin between them
  };
  Brows brows;
  std::array<float, kLastingCreases> creases{};                    ///< by Crease
  UnitTable units{};                                               ///< added to BuiltInUnits()
  std::shared_ptr<const Features> features = Features::BuiltIn();  ///< never null
};

/// Returns a built-in face as its table describes it. Throws std::runtime_error listing the names
/// if `name` is unknown.
Identity BuiltInIdentity(std::string_view name);
/// Returns the names of all sliders, in the order of their table.
std::vector<std::string> SliderNames();

/// Reads a user's own face, the file identity.txt in its folder: `base FACE`, then lines as in
/// tables/identities.txt that modify it; a slider replaces an earlier one of the same name. `name`
/// appears in error messages. Throws std::runtime_error naming file and line. Limit: kMaxSlider in
/// absolute value.
Identity ReadOwnIdentity(const std::string& name, std::string_view text);
/// Returns the text of such a file with sliders only.
std::string WriteOwnIdentity(std::string_view base,
                             const std::map<std::string, float, std::less<>>& sliders);
inline constexpr float kMaxSlider = 10;

/// The sliders as a displacement field.
class SliderWarp {
 public:
  /// Throws std::runtime_error if a slider is not in the table or a line is damaged.
  SliderWarp(const Table& table, const std::vector<std::pair<std::string, float>>& values);
  glm::vec3 Motion(glm::vec3 p) const;

 private:
  struct Field {
    glm::vec3 centre, radius, displacement;
  };
  std::vector<Field> fields_;
};

}  // namespace fsm

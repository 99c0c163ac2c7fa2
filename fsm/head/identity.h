#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fsm/base/table_reader.h"
#include "fsm/head/features.h"
#include "fsm/rig/eye_transform.h"
#include "fsm/rig/unit_table.h"

namespace fsm {

/// The names of the built-in faces, blocks of tables/identities.txt; the default one first. Valid
/// as long as the program runs.
const std::vector<std::string>& Identities();
bool IsBuiltIn(std::string_view name);

/// Colours of a head, linear RGB; see BasePalette.
struct Palette {
  glm::vec3 skin{}, blush{}, lip{}, hair{}, brow{}, lash{}, iris{}, cloth{}, tooth{}, sclera{};
  glm::vec3 lip_inside{}, lid_rim{}, mouth{}, tongue{}, gum{};
  float beard = 0;  ///< how far a shaved beard shows, 0..1
};

/// The colours of the base head: the rows of tables/identities.txt that stand before any face.
const Palette& BasePalette();

/// Short hair all round.
struct CropStyle {
  float side_mm, top_mm;  ///< of the shell over the skin
  int locks;
  float lock_mm;   ///< length of a lock
  float lift_mm;   ///< of its tip over the shell
  float wave_mm;   ///< sideways swing of a lock
  float front_up;  ///< how far locks over the forehead stand up, 0..1
  float recede;    ///< degrees the hairline is drawn back at the temples
  float curl = 0;  ///< 0: hairs lie along the head; 1: tight curls, which stand off it
};

/// Hair that is parted and hangs.
struct LongStyle {
  float parting = 0.17f;  ///< to the agent's left, as part of the hair's half width
  float full_mm = 0;      ///< more volume over the skull than usual
  float front_y = -84;    ///< height of the ends beside the face, millimetres
  float back_y = -112;    ///< of those behind
  float wave_mm = 2.2f;   ///< sideways swing of what hangs
};

/// What makes one face differ from the base head; a block of tables/identities.txt.
struct Identity {
  std::size_t index = 0;  ///< in Identities()
  Palette palette = BasePalette();
  std::vector<std::pair<std::string, float>> sliders;
  std::optional<CropStyle> crop;  ///< long hair if empty
  LongStyle long_hair;
  EyeTransform eyes;  ///< the left one; `shift` is what the sliders make it
  /// The furrow over the upper lid, compared with the base head's.
  struct LidFold {
    float inner_mm = 0, outer_mm = 0;  ///< how much higher it lies at the eye's two corners
    float dark = 1;                    ///< factor on how dark it is
    float full_mm = 0;                 ///< how much thicker the skin is, there and above
  };
  LidFold fold;
  float lashes = 1;
  struct Brows {
    float thickness = 1, height_mm = 0;
    float arch = 1;     ///< how much they bend: 0 = straight from end to end
    float density = 1;  ///< how many of their hairs there are, and how dark the skin between is
  };
  Brows brows;
  std::array<float, kLastingCreases> creases{};  ///< by Crease
  std::shared_ptr<const Features> features{};    ///< in place of the built-in ones

  /// `features`, or else the built-in ones.
  const Features& UsedFeatures() const { return features ? *features : Features::BuiltIn(); }
};

/// Throws std::runtime_error listing the names for an unknown one, or naming file and line for a
/// damaged table.
Identity ReadIdentity(const Table& table, std::string_view name);
/// One line of a face's block; a slider takes the place of one of the same name.
void ReadIdentityRow(const TableRow& row, Identity& identity);

/// A built-in face as its table has it. Throws as ReadIdentity.
Identity BuiltInIdentity(std::string_view name);
/// The sliders there are, in the order of their table.
std::vector<std::string> SliderNames();

/// A face of one's own, the file identity.txt in its folder: `base FACE`, then lines as in
/// tables/identities.txt that change it. `name` is for messages. Throws std::runtime_error naming
/// file and line. Limit: kMostSlider either way.
Identity ReadOwnIdentity(const std::string& name, std::string_view text);
/// Such a file with sliders only.
std::string WriteOwnIdentity(std::string_view base,
                             const std::map<std::string, float, std::less<>>& sliders);
inline constexpr float kMostSlider = 10;

/// The sliders as a displacement of space.
class SliderWarp {
 public:
  /// Throws std::runtime_error if a slider asked for is not in the table or a line is damaged.
  SliderWarp(const Table& table, const std::vector<std::pair<std::string, float>>& values);
  glm::vec3 Motion(glm::vec3 p) const;

 private:
  struct Field {
    glm::vec3 at, radius, by;
  };
  std::vector<Field> fields_;
};

}  // namespace fsm

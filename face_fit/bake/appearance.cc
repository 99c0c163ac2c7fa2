#include "face_fit/bake/appearance.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>

#include "embedded/face_fit_appearance.h"
#include "fsm/base/table_reader.h"

namespace facefit {
namespace {

using A = Appearance;
using Member = std::variant<float A::*, glm::vec2 A::*, glm::vec3 A::*>;

constexpr std::pair<std::string_view, Member> kMembers[] = {
    {"facing_least", &A::facing_least},
    {"facing_least_aside", &A::facing_least_aside},
    {"facing_soft", &A::facing_soft},
    {"aside_across", &A::aside_across},
    {"aside_above_chin", &A::aside_above_chin},
    {"smile_folds_filled", &A::smile_folds_filled},
    {"smile_shade_evened", &A::smile_shade_evened},
    {"fold_half_width", &A::fold_half_width},
    {"fold_reach", &A::fold_reach},
    {"shade_texels", &A::shade_texels},
    {"roughness", &A::roughness},
    {"crease_smooth", &A::crease_smooth},
    {"mouth_line_grey", &A::mouth_line_grey},
    {"mouth_line_colour", &A::mouth_line_colour},
    {"colour_difference", &A::colour_difference},
    {"hair_darker", &A::hair_darker},
    {"hair_edge", &A::hair_edge},
    {"light_gain", &A::light_gain},
    {"other_side_light", &A::other_side_light},
    {"lip_inside", &A::lip_inside},
    {"lip_soft", &A::lip_soft},
    {"lip_beside", &A::lip_beside},
    {"lip_reddened", &A::lip_reddened},
    {"lip_inner", &A::lip_inner},
    {"teeth_light", &A::teeth_light},
    {"squint_kept", &A::squint_kept},
    {"lash_rim", &A::lash_rim},
    {"mouth_rim", &A::mouth_rim},
    {"iris_gain", &A::iris_gain},
    {"iris_darkest", &A::iris_darkest},
    {"iris_unseen", &A::iris_unseen},
    {"white_unseen", &A::white_unseen},
    {"white_greyed", &A::white_greyed},
    {"white_least", &A::white_least},
    {"beside_iris", &A::beside_iris},
    {"lid_shade", &A::lid_shade},
    {"flash_redder", &A::flash_redder},
    {"flash_bluer", &A::flash_bluer},
    {"flash_bright", &A::flash_bright},
    {"flash_pupil", &A::flash_pupil},
    {"skin_below_chin", &A::skin_below_chin},
    {"sheet_rim", &A::sheet_rim},
    {"hair_depth", &A::hair_depth},
    {"shoulder_depth", &A::shoulder_depth},
    {"beyond_photo", &A::beyond_photo},
    {"shoulder_round", &A::shoulder_round},
    {"shoulder_fall", &A::shoulder_fall},
    {"hole_face", &A::hole_face},
    {"hole_neck", &A::hole_neck},
    {"outline_doubt", &A::outline_doubt},
};

void Read(const fsm::TableRow& row, const Member& member, Appearance& out) {
  constexpr float kMost = 1000;
  const auto numbers = row.Numbers(1);
  const std::size_t count = member.index() + 1;
  if (numbers.size() != count) {
    row.Fail("'" + row.key() + "' needs " + std::to_string(count) + " numbers after it, found " +
             std::to_string(numbers.size()));
  }
  for (const float v : numbers) {
    if (std::abs(v) > kMost) row.Fail("a number beyond -1000 to 1000");
  }
  const auto set = [&]<typename T>(T A::*at) {
    if constexpr (std::is_same_v<T, float>) {
      out.*at = numbers[0];
    } else {
      for (std::size_t i = 0; i < count; ++i) (out.*at)[static_cast<int>(i)] = numbers[i];
    }
  };
  std::visit(set, member);
}

}  // namespace

Appearance ReadAppearance(const std::string& name, std::string_view text) {
  Appearance out{};
  std::set<std::string> seen;
  const fsm::Table table(name, text);
  for (const fsm::TableRow& row : table.rows()) {
    const auto* found =
        std::ranges::find(kMembers, row.key(), &std::pair<std::string_view, Member>::first);
    if (found == std::end(kMembers)) row.Fail("'" + row.key() + "' is not known");
    if (!seen.insert(row.key()).second) row.Fail("'" + row.key() + "' is there twice");
    Read(row, found->second, out);
  }
  for (const auto& [key, member] : kMembers) {
    if (seen.contains(std::string(key))) continue;
    throw std::runtime_error(name + ": '" + std::string(key) + "' is missing");
  }
  return out;
}

const Appearance& BuiltInAppearance() {
  static const Appearance table = ReadAppearance("appearance.txt", embedded::face_fit_appearance());
  return table;
}

}  // namespace facefit

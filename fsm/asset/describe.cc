#include "fsm/asset/describe.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <set>

#include "fsm/asset/material_name.h"
#include "fsm/rig/rig_steps.h"

namespace fsm {
namespace {

class Description {
 public:
  explicit Description(const Head& head)
      : head_(head), surface_(head.surface()), rig_(head.rig().data()) {}

  std::string Text() {
    Line("mesh", "{} vertices, {} triangles", rig_.rest.size(), surface_.indices.size() / 3);
    Parts();
    Pictures();
    Bones();
    Channels();
    Springs();
    Steps();
    DescribeLandmarks();
    return std::move(text_);
  }

 private:
  template <typename... Values>
  void Line(std::string_view what, fmt::format_string<Values...> format, Values&&... values) {
    text_ += fmt::format("{:<12}{}\n", what, fmt::format(format, std::forward<Values>(values)...));
  }

  void Parts() {
    std::map<Material, std::size_t> triangles;
    for (const auto& part : surface_.parts) triangles[part.material] += part.index_count / 3;
    for (const auto& [material, count] : triangles)
      Line("part", "{}, {} triangles", MaterialName(material), count);
  }

  void Pictures() {
    const std::pair<const char*, const std::shared_ptr<const Image>&> pictures[] = {
        {"photo, sRGB", surface_.textures.base_colour},
        {"normal_map, linear", surface_.textures.normal_roughness_metal},
        {"emissive_map, sRGB", surface_.textures.emission_openness}};
    for (const auto& [name, image] : pictures) {
      if (image) Line("texture", "{}, {} x {}", name, image->width, image->height);
    }
    if (!surface_.pbr_materials.empty())
      Line("materials", "{} of its own", surface_.pbr_materials.size());
  }

  void Bones() {
    static constexpr std::array<const char*, kValuesOf<Bone>> kNames{
        "skin", "skull", "jaw", "tongue", "eye_left", "eye_right"};
    std::array<std::size_t, kNames.size()> vertices{};
    for (const Bone bone : rig_.bone) ++vertices[static_cast<std::size_t>(bone)];
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      if (vertices[i] > 0) Line("bone", "{}, {} vertices", kNames[i], vertices[i]);
    }
  }

  void Channels() {
    std::map<std::string_view, std::set<int>> drives;  // numbers, by kind
    std::size_t moves = 0;
    for (const Channel& channel : rig_.channels) {
      for (const Channel::Driver& driver : channel.drivers) {
        const bool mouth = driver.drive.kind == Drive::Kind::kMouth ||
                           driver.drive.kind == Drive::Kind::kSpokenMouth ||
                           driver.drive.kind == Drive::Kind::kHandMouth;
        drives[KindName(driver.drive.kind)].insert(driver.drive.number + (mouth ? 1 : 0));
      }
      moves += channel.moves.size();
    }
    Line("channels", "{}, {} displacements", rig_.channels.size(), moves);
    for (const auto& [kind, numbers] : drives) {
      std::string listed;
      if (numbers != std::set{0}) {
        for (const int number : numbers) listed += fmt::format(" {}", number);
      }
      Line("driven by", "{}{}", kind, listed);
    }
  }
  static std::string_view KindName(Drive::Kind kind) {
    static constexpr std::array<const char*, kValuesOf<Drive::Kind>> kNames{
        "units", "units as asked", "mouth",      "mouth of speech", "mouth by hand",
        "blink", "gaze up",        "gaze right", "residuals"};
    return kNames[static_cast<std::size_t>(kind)];
  }

  void Springs() {
    if (rig_.spring_rig.springs.empty()) return;
    Line("springs", "{}, moving vertices by {} weights", rig_.spring_rig.springs.size(),
         rig_.spring_rig.weights.size());
  }

  void Steps() {
    std::vector<std::string_view> names;
    for (const RigStep step : rig_.steps) names.push_back(DefinitionOf(step).name);
    Line("steps", "{}", fmt::join(names, ", "));
  }

  void DescribeLandmarks() {
    for (const auto& [name, place] : head_.landmarks()) {
      Line("landmark", "{} {:.1f} {:.1f} {:.1f} mm", name, place.x, place.y, place.z);
    }
  }

  const Head& head_;
  const HeadSurface& surface_;
  const RigData& rig_;
  std::string text_;
};

}  // namespace

std::string Describe(const Head& head) { return Description(head).Text(); }

}  // namespace fsm

#include "fsm/app/contact_sheet.h"

#include <algorithm>
#include <chrono>
#include <iterator>

#include "fsm/app/contact_sheet_font.h"
#include "fsm/app/slot_words.h"
#include "fsm/motion/face_motion.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr int kLabelHeight = 22;
constexpr int kGap = 2;
constexpr std::uint8_t kPaper = 235;

/// The scale of a figure in its cell, and its shift upward (mm at the face).
struct Framing {
  float scale, up;
};
constexpr Framing kWholeFace{1.18f, -8}, kMouth{2.9f, 50}, kBust{1, 0};

FaceState Framed(FaceState state, const Framing& framing) {
  state.figure.scale *= framing.scale;
  state.figure.translation = {0, framing.up};
  return state;
}

/// Units that must be set as well for a unit to be visible.
constexpr std::pair<int, const char*> kCompanions[] = {
    {8, " 26 0.5"}, {19, " 25 0.6 26 0.5"}, {37, " 25 0.6 26 0.5"}};
constexpr const char* kEmotions[] = {"HAPPY", "SAD", "SURPRISED", "FEARED", "ANGRY", "DISGUSTED"};

std::string Companions(int unit) {
  const auto found = std::ranges::find(kCompanions, unit, &std::pair<int, const char*>::first);
  return found == std::end(kCompanions) ? "" : found->second;
}

/// The arguments of MakeSheet.
struct SheetInput {
  const MotionTables& tables;
  const std::vector<std::string>& faces;
  const std::string& face;
};

ContactSheet UnitSheet(const SheetInput& input) {
  ContactSheet sheet{{}, 10};
  sheet.cells.push_back({"NEUTRAL", Framed({}, kWholeFace), input.face});
  for (const auto& [number, name] : input.tables.unit_names.names) {
    const std::string text = std::to_string(number) + " 1" + Companions(number);
    const FaceState state = SettledAfter(
        input.tables, [&](FaceMotion& motion) { vm::OrThrow(motion.action_units.Set(0ms, text)); });
    sheet.cells.push_back(
        {std::to_string(number) + " " + name, Framed(state, kWholeFace), input.face});
  }
  return sheet;
}

ContactSheet EmotionSheet(const SheetInput& input) {
  ContactSheet sheet{{}, 4};
  sheet.cells.push_back({"NEUTRAL", Framed({}, kWholeFace), input.face});
  for (const char* name : kEmotions) {
    if (!input.tables.expressions.contains(name)) continue;
    const FaceState state = SettledAfter(input.tables, [&](FaceMotion& motion) {
      vm::OrThrow(motion.expression.Show(0ms, name, 1, 1, 0ms));
    });
    sheet.cells.push_back({name, Framed(state, kWholeFace), input.face});
  }
  return sheet;
}

ContactSheet VisemeSheet(const SheetInput& input) {
  ContactSheet sheet{{}, 7};
  for (const VisemeSetId set : {VisemeSetId::k28, VisemeSetId::k14}) {
    const std::string prefix = std::to_string(CountOf(set)) + " ";
    for (const Viseme& viseme : input.tables.set(set).visemes) {
      sheet.cells.push_back({prefix + viseme.name, Framed(StateOf(viseme), kMouth), input.face});
    }
  }
  return sheet;
}

ContactSheet IdentitySheet(const SheetInput& input) {
  ContactSheet sheet{{}, 4};
  const FaceState smile = SettledAfter(input.tables, [](FaceMotion& motion) {
    static_cast<void>(motion.expression.Show(0ms, "HAPPY", 1, 1, 0ms));  // without HAPPY: at rest
  });
  for (const std::string& face : input.faces) {
    for (const float turn : {0.0f, 35.0f, 85.0f}) {
      FaceState state;
      state.figure.rotation = {0, turn, 0};
      sheet.cells.push_back(
          {face + " " + std::to_string(static_cast<int>(turn)), Framed(state, kBust), face});
    }
    sheet.cells.push_back({face + " HAPPY", Framed(smile, kBust), face});
  }
  return sheet;
}

constexpr SlotWord<ContactSheet (*)(const SheetInput&)> kKinds[] = {{"aus", UnitSheet},
                                                                    {"emotions", EmotionSheet},
                                                                    {"visemes", VisemeSheet},
                                                                    {"identities", IdentitySheet}};

void Paste(const Image& from, Image& to, int x, int y) {
  for (int row = 0; row < from.height; ++row) {
    const auto* begin = from.rgba.data() + static_cast<std::ptrdiff_t>(4) * row * from.width;
    auto* out = to.rgba.data() + static_cast<std::ptrdiff_t>(4) * ((y + row) * to.width + x);
    std::copy(begin, begin + static_cast<std::ptrdiff_t>(4) * from.width, out);
  }
}

}  // namespace

vm::Result<ContactSheet> MakeSheet(const std::string& kind, const MotionTables& tables,
                                   const std::vector<std::string>& faces, const std::string& face) {
  if (const auto make = ValueOf(kKinds, kind)) return (*make)({tables, faces, face});
  return vm::Fail(vm::Errc::kBadValue,
                  "there is no sheet '" + kind + "'; " + GrammarOf(kKinds) + " expected");
}

vm::Result<Image> DrawSheet(FaceView& view, FaceLibrary& library, const ContactSheet& sheet,
                            bool labels) {
  if (auto sized = view.Resize(kCellWidth, kCellHeight); !sized) {
    return std::unexpected(sized.error());
  }
  const int count = static_cast<int>(sheet.cells.size());
  const int rows = (count + sheet.columns - 1) / sheet.columns;
  const int cell_height = kCellHeight + kGap + (labels ? kLabelHeight : 0);
  Image picture = FilledImage(sheet.columns * (kCellWidth + kGap) + kGap, rows * cell_height + kGap,
                              {kPaper, kPaper, kPaper, 255});
  for (int i = 0; i < count; ++i) {
    const ContactSheetCell& cell = sheet.cells[static_cast<std::size_t>(i)];
    if (!cell.face.empty()) {
      if (auto selected = library.Select(cell.face); !selected)
        return std::unexpected(selected.error());
    }
    if (auto drawn = view.Draw(cell.state, Scene{}, nullptr); !drawn) {
      return std::unexpected(drawn.error());
    }
    const int x = kGap + (i % sheet.columns) * (kCellWidth + kGap);
    const int y = kGap + (i / sheet.columns) * cell_height;
    const Image& image = view.Read();
    if (image.width == kCellWidth && image.height == kCellHeight) Paste(image, picture, x, y);
    if (!labels) continue;
    const int scale = TextWidth(2, cell.label) <= kCellWidth ? 2 : 1;
    DrawText(picture, x + (kCellWidth - TextWidth(scale, cell.label)) / 2,
             y + kCellHeight + (kLabelHeight - 7 * scale) / 2, scale, cell.label);
  }
  return picture;
}

}  // namespace fsm

#include "fsm/app/original_config.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "fsm/motion/table_text.h"
#include "vm_protocol/core/file_kind.h"

namespace fsm {
namespace {

vm::Result<std::string> ReadAll(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream bytes;
  if (!in || !(bytes << in.rdbuf())) return vm::Fail(vm::Errc::kUnavailable, "cannot read " + path);
  return bytes.str();
}

/// Files of all faces, by their key.
const std::map<std::string, std::string OriginalConfig::*, std::less<>> kSharedFiles = {
    {"DEF_WFM_PNT", &OriginalConfig::standard_wireframe},
    {"DEF_WFM_LNK", &OriginalConfig::link},
    {"U_TEETH_OBJ_NAME", &OriginalConfig::upper_teeth},
    {"L_TEETH_OBJ_NAME", &OriginalConfig::lower_teeth},
    {"EYE_OBJ_NAME", &OriginalConfig::eye_object},
    {"M_WALL_TEXTURE", &OriginalConfig::mouth_picture}};

/// The mask of that name, made if need be; nullptr if there are too many. Valid until the next
/// call.
OriginalConfig::Mask* MaskOf(OriginalConfig& config, const std::string& name) {
  const auto found = std::ranges::find(config.masks, name, &OriginalConfig::Mask::name);
  if (found != config.masks.end()) return &*found;
  if (config.masks.size() >= OriginalConfig::kMaxMasks) return nullptr;
  config.masks.push_back({name, "", "", "", "", ""});
  return &config.masks.back();
}

}  // namespace

vm::Result<OriginalConfig> OriginalConfig::Read(const std::string& path) {
  const auto text = ReadAll(path);
  if (!text) return std::unexpected(text.error());
  const TableText table(path, *text);
  OriginalConfig config;
  config.path = path;

  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const auto find_file = [&folder](const std::string& name) {
    std::error_code code;
    if (std::filesystem::exists(name, code)) return name;
    return (folder / name).string();
  };
  for (const TableLine& line : table.lines()) {
    const std::string& key = line.words[0];
    const auto word = [&line](std::size_t i) {
      return i < line.words.size() ? line.words[i] : std::string();
    };
    const auto number = [&](std::size_t i, double lowest, double highest) {
      return table.Number(line, i, "a value of " + key, lowest, highest);
    };
    vm::Result<double> value = 0.0;
    if (key == "DEF_WINDOW_WIDTH" || key == "DEF_WINDOW_HEIGHT") {
      value = number(1, 16, 8192);
      if (value) (key.ends_with("WIDTH") ? config.width : config.height) = static_cast<int>(*value);
    } else if (key == "DEF_WINDOW_POS_X" || key == "DEF_WINDOW_POS_Y") {
      value = number(1, -100000, 100000);
      if (value) (key.ends_with("X") ? config.x : config.y) = static_cast<int>(*value);
    } else if (key == "EXPRESSION_DURATION") {
      value = number(1, 0, 60000);
      if (value) config.expression_ms = *value;
    } else if (key == "EYEMOVE_DURATION") {
      value = number(1, 0, 60000);
      if (value) config.eye_move_ms = *value;
    } else if (key == "MaxFrameRate") {
      value = number(1, 1, 240);
      if (value) config.max_frame_rate = *value;
    } else if (key == "SetViseme") {
      if (word(1) != "JP" && word(1) != "EN") return table.Wrong(line.number, "JP or EN expected");
      config.language = word(1) == "JP" ? Language::kJapanese : Language::kEnglish;
    } else if (key == "BackgroundFile") {
      if (line.words.size() < 3) return table.Wrong(line.number, "a name and a file expected");
      config.backgrounds.emplace_back(word(1), find_file(word(2)));
    } else if (key == "MaskFile" || key == "MaskEye" || key == "MaskTeeth") {
      const std::size_t files = key == "MaskTeeth" ? 1 : 2;
      if (line.words.size() < files + 2) {
        return table.Wrong(line.number, files == 1 ? "a name and a file expected"
                                                   : "a name and two files expected");
      }
      OriginalConfig::Mask* mask = MaskOf(config, word(1));
      if (!mask) {
        return table.Wrong(line.number, "at most " + std::to_string(kMaxMasks) + " faces are read");
      }
      if (key == "MaskFile") {
        if (mask->wireframe.empty()) {  // other lines may name it before its own does
          std::rotate(mask, mask + 1, config.masks.data() + config.masks.size());
          mask = &config.masks.back();
        }
        mask->picture = find_file(word(2));
        mask->wireframe = find_file(word(3));
      } else if (key == "MaskEye") {
        mask->eye_picture = find_file(word(2));
        mask->eye_def = find_file(word(3));
      } else {
        mask->teeth_def = find_file(word(2));
      }
    } else if (const auto shared = kSharedFiles.find(key); shared != kSharedFiles.end()) {
      if (line.words.size() < 2) return table.Wrong(line.number, "a file expected");
      config.*shared->second = find_file(word(1));
    } else if (key == "FaceMotNod" || key == "FaceMotRefuse" || key == "FaceMotListen" ||
               key == "FaceMotUserDef") {
      std::string kind = key.substr(std::string("FaceMot").size());
      for (char& c : kind) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
      config.motions[kind].push_back(find_file(word(1)));
    } else if (key == "FaceMotBlink") {
      value = number(1, 1, 60000);
      if (value) config.blinks_ms.push_back(*value);
    } else if (key == "AutonomousBlink") {
      value = number(1, 0.01, 100);
      const auto pattern = number(2, 1, 1000);
      if (!pattern) return std::unexpected(pattern.error());
      if (value) config.auto_blinks.emplace_back(*value, static_cast<int>(*pattern));
    } else if (key == "AutonomousMove") {
      config.auto_moves.push_back(find_file(word(1)));
    } else if (key == "AutonomousUserdef") {
      config.auto_userdefs.push_back(find_file(word(1)));
    }
    if (!value) return std::unexpected(value.error());
  }
  std::erase_if(config.masks, [](const Mask& mask) { return mask.wireframe.empty(); });
  return config;
}

std::vector<std::string> OriginalConfig::MaskNames() const {
  std::vector<std::string> names;
  for (const Mask& mask : masks) names.push_back(mask.name);
  return names;
}

namespace {

HeadCurve LeaningAsOurs(const HeadCurve& curve) {
  std::vector<HeadCurve::Key> keys(curve.keys().begin(), curve.keys().end());
  for (HeadCurve::Key& key : keys) key.angles[2] = -key.angles[2];
  return HeadCurve(std::move(keys));
}

vm::Result<std::vector<HeadCurve>> ReadCurves(const std::vector<std::string>& files) {
  std::vector<HeadCurve> curves;
  for (const std::string& file : files) {
    if (auto fit = vm::CheckReadable(file); !fit) return std::unexpected(fit.error());
    const auto text = ReadAll(file);
    if (!text) return std::unexpected(text.error());
    auto curve = ReadMotionFile(file, *text);
    if (!curve) return std::unexpected(curve.error());
    curves.push_back(LeaningAsOurs(*curve));
  }
  return curves;
}

}  // namespace

vm::Result<void> OriginalConfig::ApplyTo(MotionTables& tables) const {
  MotionTable& table = tables.motions;
  for (const auto& [kind, files] : motions) {
    auto curves = ReadCurves(files);
    if (!curves) return std::unexpected(curves.error());
    table.head[kind] = std::move(*curves);
  }
  for (const auto& [files, out] : {std::pair{&auto_moves, &table.auto_move_files},
                                   std::pair{&auto_userdefs, &table.auto_userdef}}) {
    if (files->empty()) continue;
    auto curves = ReadCurves(*files);
    if (!curves) return std::unexpected(curves.error());
    *out = std::move(*curves);
  }
  for (const auto& [name, looks] : expressions) {
    auto& patterns = tables.emotions[name].patterns;
    for (const auto& [pattern, look] : looks) {
      const auto index = static_cast<std::size_t>(pattern - 1);
      patterns.resize(std::max(patterns.size(), index + 1));
      patterns[index] = look;
    }
  }
  if (!blinks_ms.empty()) table.blinks.clear();
  for (const double ms : blinks_ms) {
    // Two fifths closing, as lids close faster than they open.
    table.blinks.push_back({0.4 * ms, 0.05 * ms, 0.55 * ms});
  }
  if (!auto_blinks.empty()) table.auto_blinks.clear();
  for (const auto& [percent, pattern] : auto_blinks) {
    if (static_cast<std::size_t>(pattern) > table.blinks.size()) {
      return vm::Fail(vm::Errc::kBadValue, path + ": AutonomousBlink names blink pattern " +
                                               std::to_string(pattern) + ", which there is not");
    }
    // The original draws lots for every frame, 30 a second.
    constexpr double kFrameMs = 1000.0 / 30;
    table.auto_blinks.push_back(
        {std::max(500.0, kFrameMs * 100 / percent), static_cast<std::size_t>(pattern) - 1, false});
  }
  // Built-in autonomous blinks may now point past the patterns the file gave.
  for (AutoBlink& blink : table.auto_blinks) {
    blink.blink = std::min(blink.blink, table.blinks.size() - 1);
  }
  return {};
}

}  // namespace fsm

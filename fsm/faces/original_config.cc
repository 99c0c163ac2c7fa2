#include "fsm/faces/original_config.h"

#include <algorithm>
#include <filesystem>

#include "fsm/base/table_reader.h"
#include "fsm/motion/inputs/motion_reader.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

/// The files that all faces share, by key.
const std::map<std::string, std::string OriginalSharedFiles::*, std::less<>> kSharedFiles = {
    {"DEF_WFM_PNT", &OriginalSharedFiles::standard},
    {"DEF_WFM_LNK", &OriginalSharedFiles::link},
    {"U_TEETH_OBJ_NAME", &OriginalSharedFiles::upper_teeth},
    {"L_TEETH_OBJ_NAME", &OriginalSharedFiles::lower_teeth},
    {"EYE_OBJ_NAME", &OriginalSharedFiles::eye},
    {"M_WALL_TEXTURE", &OriginalSharedFiles::mouth_picture}};

/// A key with one number: its bounds, and a function that stores it.
struct NumberKey {
  double min, max;
  void (*store)(OriginalConfig&, double);
};
const std::map<std::string, NumberKey, std::less<>> kNumbers = {
    {"DEF_WINDOW_WIDTH",
     {16, 8192, [](OriginalConfig& c, double v) { c.width = static_cast<int>(v); }}},
    {"DEF_WINDOW_HEIGHT",
     {16, 8192, [](OriginalConfig& c, double v) { c.height = static_cast<int>(v); }}},
    {"DEF_WINDOW_POS_X",
     {-100000, 100000, [](OriginalConfig& c, double v) { c.x = static_cast<int>(v); }}},
    {"DEF_WINDOW_POS_Y",
     {-100000, 100000, [](OriginalConfig& c, double v) { c.y = static_cast<int>(v); }}},
    {"EXPRESSION_DURATION", {0, 60000, [](OriginalConfig& c, double v) { c.expression_ms = v; }}},
    {"EYEMOVE_DURATION", {0, 60000, [](OriginalConfig& c, double v) { c.eye_move_ms = v; }}},
    {"MaxFrameRate", {1, 240, [](OriginalConfig& c, double v) { c.max_frame_rate = v; }}},
    {"FaceMotBlink", {1, 60000, [](OriginalConfig& c, double v) { c.blinks_ms.push_back(v); }}}};

/// Parts of a blink, of which the original has the length only: lids close faster than they open.
constexpr double kClosing = 0.4, kShut = 0.05, kOpening = 0.55;
constexpr double kOriginalFrameMs = 1000.0 / 30;  // in each of which it may blink
constexpr double kMinInterval = 500;              // between blinks, ms

/// Keys of movement files -> kinds of FaceMot.
const std::map<std::string, std::string, std::less<>> kMotions = {{"FaceMotNod", "NOD"},
                                                                  {"FaceMotRefuse", "REFUSE"},
                                                                  {"FaceMotListen", "LISTEN"},
                                                                  {"FaceMotUserDef", "USERDEF"}};

/// Reads the rows of a configuration one by one.
class ConfigReader {
 public:
  explicit ConfigReader(const std::string& path)
      : folder_(std::filesystem::path(path).parent_path()) {
    config_.path = config_.shared.config = path;
  }

  OriginalConfig Read(const Table& table) {
    for (const TableRow& row : table.rows()) ReadRow(row);
    std::erase_if(config_.faces, [](const auto& face) { return face.wireframe.empty(); });
    config_.shared.offsets = std::filesystem::path(config_.shared.standard).parent_path().string();
    return std::move(config_);
  }

 private:
  void ReadRow(const TableRow& row) {
    const std::string& key = row.key();
    if (const auto known = kNumbers.find(key); known != kNumbers.end()) {
      known->second.store(config_, Number(row, 1, known->second.min, known->second.max));
    } else if (key == "SetViseme") {
      const std::string word = Word(row, 1);
      if (word != "JP" && word != "EN") row.Refuse("JP or EN expected");
      config_.language = word == "JP" ? Language::kJapanese : Language::kEnglish;
    } else if (key == "BackgroundFile") {
      if (row.size() < 3) row.Refuse("a name and a file expected");
      config_.backgrounds.emplace_back(Word(row, 1), File(row, 2));
    } else if (key == "MaskFile" || key == "MaskEye" || key == "MaskTeeth") {
      ReadMask(row);
    } else if (const auto shared = kSharedFiles.find(key); shared != kSharedFiles.end()) {
      if (row.size() < 2) row.Refuse("a file expected");
      config_.shared.*shared->second = File(row, 1);
    } else if (const auto motion = kMotions.find(key); motion != kMotions.end()) {
      config_.motions[motion->second].push_back(File(row, 1));
    } else if (key == "AutonomousBlink") {
      const double per_cent = Number(row, 1, 0.01, 100);
      config_.auto_blinks.emplace_back(per_cent, static_cast<int>(Number(row, 2, 1, 1000)));
    } else if (key == "AutonomousMove") {
      config_.auto_moves.push_back(File(row, 1));
    } else if (key == "AutonomousUserdef") {
      config_.auto_userdefs.push_back(File(row, 1));
    }
  }

  void ReadMask(const TableRow& row) {
    const std::string& key = row.key();
    const std::size_t files = key == "MaskTeeth" ? 1 : 2;
    if (row.size() < files + 2) {
      row.Refuse(files == 1 ? "a name and a file expected" : "a name and two files expected");
    }
    OriginalFaceFiles* face = &FaceOf(row);
    if (key == "MaskFile") {
      if (face->wireframe.empty()) {  // it may occur in other lines before its own
        std::rotate(face, face + 1, config_.faces.data() + config_.faces.size());
        face = &config_.faces.back();
      }
      face->picture = File(row, 2);
      face->wireframe = File(row, 3);
    } else if (key == "MaskEye") {
      face->eye_picture = File(row, 2);
      face->eye_def = File(row, 3);
    } else {
      face->teeth_def = File(row, 2);
    }
  }

  /// Returns the face that the row names, added if it is new. Valid until the next call.
  OriginalFaceFiles& FaceOf(const TableRow& row) {
    const std::string& name = row.Word(1);
    const auto found = std::ranges::find(config_.faces, name, &OriginalFaceFiles::name);
    if (found != config_.faces.end()) return *found;
    if (config_.faces.size() >= OriginalConfig::kMaxFaces) {
      row.Refuse("at most " + std::to_string(OriginalConfig::kMaxFaces) + " faces are read");
    }
    return config_.faces.emplace_back(name);
  }

  static std::string Word(const TableRow& row, std::size_t i) {
    return i < row.size() ? row.Word(i) : std::string();
  }
  static double Number(const TableRow& row, std::size_t i, double min, double max) {
    return row.Within<double>(i, min, max, "a value of " + row.key());
  }
  /// Returns a file's path as given if it exists, else relative to the configuration's folder.
  std::string File(const TableRow& row, std::size_t i) const {
    const std::string name = Word(row, i);
    std::error_code code;
    if (std::filesystem::exists(name, code)) return name;
    return (folder_ / name).string();
  }

  std::filesystem::path folder_;
  OriginalConfig config_;
};

}  // namespace

vm::Result<OriginalConfig> OriginalConfig::Read(const std::string& path) {
  const auto text = vm::ReadTextFile(path, kMaxTableBytes);
  if (!text) return std::unexpected(text.error());
  return ReadTable(path, *text,
                   [&path](const Table& table) { return ConfigReader(path).Read(table); });
}

std::vector<std::string> OriginalConfig::FaceNames() const {
  std::vector<std::string> names;
  for (const OriginalFaceFiles& face : faces) names.push_back(face.name);
  return names;
}

namespace {

HeadCurve MirroredTilt(const HeadCurve& curve) {
  std::vector<HeadCurve::Key> keys(curve.keys().begin(), curve.keys().end());
  for (HeadCurve::Key& key : keys) key.angles[kTilted] = -key.angles[kTilted];
  return HeadCurve(std::move(keys));
}

vm::Result<std::vector<HeadCurve>> ReadCurves(const std::vector<std::string>& files) {
  std::vector<HeadCurve> curves;
  for (const std::string& file : files) {
    const auto text = vm::ReadTextFile(file, kMaxTableBytes);
    if (!text) return std::unexpected(text.error());
    auto curve = ReadMotionFile(file, *text);
    if (!curve) return std::unexpected(curve.error());
    curves.push_back(MirroredTilt(*curve));
  }
  return curves;
}

}  // namespace

vm::Result<void> OriginalConfig::ApplyTo(MotionTables& tables) const {
  MotionPatterns& patterns = tables.motions;
  for (const auto& [kind, files] : motions) {
    auto curves = ReadCurves(files);
    if (!curves) return std::unexpected(curves.error());
    patterns.head[kind] = std::move(*curves);
  }
  for (const auto& [files, out] : {std::pair{&auto_moves, &patterns.auto_move_files},
                                   std::pair{&auto_userdefs, &patterns.auto_userdef}}) {
    if (files->empty()) continue;
    auto curves = ReadCurves(*files);
    if (!curves) return std::unexpected(curves.error());
    *out = std::move(*curves);
  }
  for (const auto& [name, looks] : expressions) {
    for (const auto& [pattern, look] : looks)
      tables.expressions[name].Redefine(static_cast<std::size_t>(pattern), look);
  }
  if (!blinks_ms.empty()) patterns.blinks.clear();
  for (const double ms : blinks_ms) {
    patterns.blinks.push_back({kClosing * ms, kShut * ms, kOpening * ms});
  }
  if (!auto_blinks.empty()) patterns.auto_blinks.clear();
  for (const auto& [percent, pattern] : auto_blinks) {
    if (static_cast<std::size_t>(pattern) > patterns.blinks.size()) {
      return vm::Fail(vm::Errc::kBadValue, path + ": AutonomousBlink names blink pattern " +
                                               std::to_string(pattern) + ", which there is not");
    }
    patterns.auto_blinks.push_back({std::max(kMinInterval, kOriginalFrameMs * 100 / percent),
                                    static_cast<std::size_t>(pattern) - 1, false});
  }
  // Indices of built-in autonomous blinks may now exceed the patterns of the file.
  for (AutoBlink& blink : patterns.auto_blinks) {
    blink.blink = std::min(blink.blink, patterns.blinks.size() - 1);
  }
  return {};
}

}  // namespace fsm

#include "face_fit/find/network/face_networks.h"

#include <algorithm>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>
#include <optional>

#include "fsm/image/byte_order.h"
#include "vm_protocol/core/text_file.h"
#include "vm_protocol/core/user_folder.h"

namespace facefit {
namespace {

constexpr std::size_t kMaxBytes = 64U << 20;
constexpr float kMinScore = 0.5F;

/// The detector's cells: 16 x 16 with two boxes each, then 8 x 8 with six.
constexpr int kDetectorCells = 16 * 16 * 2 + 8 * 8 * 6;

// The outputs of the networks, by their order in the files.

/// Of the detector: for each of its cells a box (DetectorBox), and how certain it is of it (a
/// logit).
enum DetectorOutput : std::size_t { kDetectorBoxes, kDetectorScores };
/// The numbers of one box: centre relative to the cell's and size, then x and y of six points, of
/// which two are used. Pixels of the input.
enum DetectorBox : std::size_t {
  kBoxCentre = 0,
  kBoxSize = 2,
  kBoxRightEye = 4,
  kBoxLeftEye = 6,
  kBoxNumbers = 16
};
/// Of the landmark network: the points, and how certain it is that they lie on a face (a logit).
enum LandmarkOutput : std::size_t { kLandmarkPoints, kLandmarkCertainty };

/// Returns the centres of the detector's cells.
std::vector<glm::vec2> Anchors() {
  std::vector<glm::vec2> anchors;
  for (const auto& [cells, boxes] : {std::pair(16, 2), std::pair(8, 6)}) {
    for (int i = 0; i < cells * cells * boxes; ++i) {
      const int cell = i / boxes;
      anchors.push_back((glm::vec2(cell % cells, cell / cells) + 0.5F) / static_cast<float>(cells));
    }
  }
  return anchors;
}

/// The package stores its files concatenated in one; its loader lists where each begins.
tflite::Bytes Packed(const std::string& script, const std::string& data, const std::string& name) {
  const std::string key = "\"files\": [";
  const auto begin = script.find(key);
  const auto end = begin == std::string::npos ? begin : script.find(']', begin);
  if (end == std::string::npos) throw tflite::BadModel("the package's loader lists no files");
  const auto list =
      nlohmann::json::parse(script.substr(begin + key.size() - 1, end - begin - key.size() + 2));
  for (const auto& entry : list) {
    const std::string file = entry.at("filename");
    if (!file.ends_with("/" + name)) continue;
    const std::size_t first = entry.at("start"), last = entry.at("end");
    if (first > last || last > data.size()) break;
    return fsm::BytesOf(data).subspan(first, last - first);
  }
  throw tflite::BadModel("the package holds no " + name);
}

/// The unpacked package @mediapipe/face_mesh.
struct FaceMeshPackage {
  std::string loader, data;

  static std::optional<FaceMeshPackage> Read(const std::string& where) {
    const std::string package = where + "/face_mesh/face_mesh_solution_packed_assets";
    auto loader = vm::ReadTextFile(package + "_loader.js", kMaxBytes);
    auto data = vm::ReadTextFile(package + ".data", kMaxBytes);
    if (!loader || !data) return std::nullopt;
    return FaceMeshPackage{std::move(*loader), std::move(*data)};
  }
  /// Throws if it cannot be used.
  tflite::Network Open(const char* name) const {
    return tflite::Network(tflite::Model::Read(Packed(loader, data, name)));
  }
};

/// Returns what `open(where)` makes of the files of a folder. It returns nothing if one is missing
/// and throws if one cannot be used. `folder`: as for FaceNetworks::Load.
auto OpenNetworks(const std::string& folder, auto open)
    -> vm::Result<typename decltype(open(folder))::value_type> {
  const std::string own = vm::Environment("GALATEA_NETWORKS");
  const std::string where = !folder.empty() ? folder
                            : !own.empty()
                                ? own
                                : vm::UserFolder("XDG_CACHE_HOME", ".cache") + "/networks";
  try {
    if (auto opened = open(where)) return std::move(*opened);
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kBadValue,
                    "the networks in '" + where + "' cannot be used: " + error.what());
  }
  return vm::Fail(vm::Errc::kUnavailable,
                  "the networks that find faces are not in '" + where +
                      "'; scripts/face_networks.sh puts them there (npm packages "
                      "@mediapipe/face_mesh and @mediapipe/selfie_segmentation)");
}

/// Checks a network's shapes. `side`: of its square input, pixels; `outputs`: count of the numbers
/// of each output, in the order of the enumerations.
tflite::Network Expect(tflite::Network network, std::size_t side,
                       std::initializer_list<std::size_t> outputs) {
  bool fits =
      network.input_shape().count() == side * side * 3 && network.outputs() == outputs.size();
  std::size_t i = 0;
  for (const std::size_t n : outputs) fits = fits && network.output(i++).size() == n;
  if (!fits) throw tflite::BadModel("a network of another kind");
  return network;
}

}  // namespace

vm::Result<FaceNetworks> FaceNetworks::Load(const std::string& folder) {
  return OpenNetworks(folder, [](const std::string& where) -> std::optional<FaceNetworks> {
    const auto package = FaceMeshPackage::Read(where);
    const auto figure =
        vm::ReadTextFile(where + "/selfie_segmentation/selfie_segmentation.tflite", kMaxBytes);
    if (!package || !figure) return std::nullopt;
    return FaceNetworks(Expect(package->Open("face_detection_short_range.tflite"), kDetectorPixels,
                               {kDetectorCells * kBoxNumbers, kDetectorCells}),
                        Expect(package->Open("face_landmark.tflite"), kLandmarkInputPixels,
                               {3 * kNetworkPoints, 1}),
                        Expect(tflite::Network(tflite::Model::Read(fsm::BytesOf(*figure))),
                               kSegmentationPixels, {kSegmentationPixels * kSegmentationPixels}));
  });
}

std::vector<FaceBox> FaceNetworks::Detect(std::span<const float> pixels) {
  static const std::vector<glm::vec2> anchors = Anchors();
  detector_.Run(pixels);
  const auto boxes = detector_.output(kDetectorBoxes), scores = detector_.output(kDetectorScores);
  std::vector<FaceBox> found;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const float score = Probability(scores[i]);
    if (!(score >= kMinScore)) continue;
    const auto pair = [box = boxes.subspan(kBoxNumbers * i)](DetectorBox k) {
      return glm::vec2(box[k], box[k + 1]) / float{kDetectorPixels};
    };
    found.push_back({.centre = anchors[i] + pair(kBoxCentre),
                     .size = glm::abs(pair(kBoxSize)),
                     .score = score,
                     .eyes = {anchors[i] + pair(kBoxRightEye), anchors[i] + pair(kBoxLeftEye)}});
  }
  return found;
}

Landmarks FaceNetworks::Locate(std::span<const float> pixels) {
  landmarks_.Run(pixels);
  return {PointsOf(landmarks_.output(kLandmarkPoints)), landmarks_.output(kLandmarkCertainty)[0]};
}

Mask FaceNetworks::SegmentPerson(std::span<const float> pixels) {
  segmentation_.Run(pixels);
  Mask person(kSegmentationPixels, kSegmentationPixels);
  std::ranges::copy(segmentation_.output(0), person.values.begin());
  return person;
}

vm::Result<tflite::Network> ReadFaceMeshNetwork(const std::string& folder, const char* name,
                                                std::size_t side,
                                                std::initializer_list<std::size_t> outputs) {
  return OpenNetworks(folder, [=](const std::string& where) -> std::optional<tflite::Network> {
    const auto package = FaceMeshPackage::Read(where);
    if (!package) return std::nullopt;
    return Expect(package->Open(name), side, outputs);
  });
}

PerPoint<glm::vec3> PointsOf(std::span<const float> output) {
  PerPoint<glm::vec3> points;
  for (std::size_t i = 0; i < kNetworkPoints; ++i) {
    points[i] = glm::vec3(output[3 * i], output[3 * i + 1], -output[3 * i + 2]) /
                float{kLandmarkInputPixels};
  }
  return points;
}

}  // namespace facefit

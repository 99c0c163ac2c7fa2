#include "face_fit/find/network/face_networks.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "face_fit/find/network/network_points.h"
#include "fsm/image/byte_order.h"
#include "vm_protocol/core/text_file.h"
#include "vm_protocol/core/user_folder.h"

namespace facefit {
namespace {

constexpr std::size_t kMaxBytes = 64U << 20;

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

std::unexpected<vm::Error> FailMissing(const std::string& where) {
  return vm::Fail(vm::Errc::kUnavailable,
                  "the networks that find faces are not in '" + where +
                      "'; scripts/face_networks.sh puts them there (npm packages "
                      "@mediapipe/face_mesh and @mediapipe/selfie_segmentation)");
}

std::unexpected<vm::Error> FailUnusable(const std::string& where, const std::exception& error) {
  return vm::Fail(vm::Errc::kBadValue,
                  "the networks in '" + where + "' cannot be used: " + error.what());
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

std::string NetworksFolder() {
  const std::string own = vm::Environment("GALATEA_NETWORKS");
  return own.empty() ? vm::UserFolder("XDG_CACHE_HOME", ".cache") + "/networks" : own;
}

vm::Result<FaceNetworks> FaceNetworks::Load(const std::string& folder) {
  const std::string where = folder.empty() ? NetworksFolder() : folder;
  const auto package = FaceMeshPackage::Read(where);
  const auto figure =
      vm::ReadTextFile(where + "/selfie_segmentation/selfie_segmentation.tflite", kMaxBytes);
  if (!package || !figure) return FailMissing(where);
  try {
    return FaceNetworks{
        .detector = Expect(package->Open("face_detection_short_range.tflite"), kDetectorPixels,
                           {kDetectorCells * kBoxNumbers, kDetectorCells}),
        .landmarks = Expect(package->Open("face_landmark.tflite"), kLandmarkInputPixels,
                            {3 * kNetworkPoints, 1}),
        .segmentation = Expect(tflite::Network(tflite::Model::Read(fsm::BytesOf(*figure))),
                               kSegmentationPixels, {kSegmentationPixels * kSegmentationPixels})};
  } catch (const std::exception& error) {
    return FailUnusable(where, error);
  }
}

vm::Result<tflite::Network> LoadAttentionLandmarks(const std::string& folder) {
  const std::string where = folder.empty() ? NetworksFolder() : folder;
  const auto package = FaceMeshPackage::Read(where);
  if (!package) return FailMissing(where);
  try {
    return Expect(package->Open("face_landmark_with_attention.tflite"), kLandmarkInputPixels,
                  {3 * kNetworkPoints, 2 * kAttentionLipPoints, 2 * kAttentionEyePoints,
                   2 * kAttentionEyePoints, 2 * kAttentionIrisPoints, 2 * kAttentionIrisPoints, 1});
  } catch (const std::exception& error) {
    return FailUnusable(where, error);
  }
}

}  // namespace facefit

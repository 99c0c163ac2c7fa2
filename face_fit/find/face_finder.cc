#include "face_fit/find/face_finder.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace facefit {
namespace {

constexpr int kDetectorSide = 128;
constexpr float kLeastScore = 0.5F;
/// How much larger than a face's box the picture is which the landmark network was trained on.
constexpr float kRoom = 1.5F;

/// Middles of the detector's cells: 16 x 16 with two boxes each, then 8 x 8 with six.
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

float Overlap(const FaceBox& a, const FaceBox& b) {
  const glm::vec2 low = glm::max(a.centre - a.size * 0.5F, b.centre - b.size * 0.5F);
  const glm::vec2 high = glm::min(a.centre + a.size * 0.5F, b.centre + b.size * 0.5F);
  const glm::vec2 common = glm::max(high - low, 0.0F);
  const float both = common.x * common.y;
  return both / (a.size.x * a.size.y + b.size.x * b.size.y - both);
}

void Detect(FaceNetworks& networks, const fsm::Image& image, const Crop& crop,
            std::vector<FaceBox>& found) {
  static const std::vector<glm::vec2> anchors = Anchors();
  networks.detector.Run(crop.Sample(image, kDetectorSide, -1, 1));
  const auto boxes = networks.detector.output(0);
  const auto scores = networks.detector.output(1);
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const float score = 1 / (1 + std::exp(-std::clamp(scores[i], -100.0F, 100.0F)));
    if (!(score >= kLeastScore)) continue;
    const float* box = &boxes[16 * i];
    const auto place = [&](int k) {
      return crop.ToPicture(anchors[i] + glm::vec2(box[k], box[k + 1]) / 128.0F);
    };
    FaceBox face{.centre = place(0),
                 .size = glm::abs(glm::vec2(box[2], box[3])) / 128.0F * crop.side,
                 .score = score,
                 .eyes = {place(4), place(6)}};
    if (face.size.x >= 8 && face.size.y >= 8) found.push_back(face);
  }
}

}  // namespace

std::vector<FaceBox> FindFaces(FaceNetworks& networks, const fsm::Image& image) {
  const glm::vec2 size(image.width, image.height);
  const float longer = std::max(size.x, size.y);
  std::vector<FaceBox> found;
  Detect(networks, image, {size * 0.5F, longer, 0}, found);
  // A face that fills the picture is too large for the network, one in a crowd too small.
  if (found.empty()) Detect(networks, image, {size * 0.5F, longer * 1.6F, 0}, found);
  float largest = 0;
  for (const FaceBox& face : found) largest = std::max(largest, face.size.x);
  for (const int parts : {2, 4}) {
    // Where faces are small there may be more, too small to be seen in the whole picture.
    if (largest > 0.6F * longer / static_cast<float>(2 * parts)) break;
    const float side = longer / static_cast<float>(parts) * 1.4F;
    for (int y = 0; y < 2 * parts; ++y) {
      for (int x = 0; x < 2 * parts; ++x) {
        const glm::vec2 centre = (glm::vec2(x, y) + 0.5F) * longer / static_cast<float>(2 * parts);
        if (centre.x > size.x || centre.y > size.y) continue;
        Detect(networks, image, {centre, side, 0}, found);
      }
    }
  }
  std::ranges::sort(found, [](const FaceBox& a, const FaceBox& b) { return a.score > b.score; });
  std::vector<FaceBox> apart;
  for (const FaceBox& face : found) {
    if (std::ranges::none_of(apart, [&](const FaceBox& f) { return Overlap(f, face) > 0.3F; })) {
      apart.push_back(face);
    }
  }
  std::ranges::sort(apart, [](const FaceBox& a, const FaceBox& b) {
    return a.size.x * a.size.y > b.size.x * b.size.y;
  });
  return apart;
}

FoundFace FindPoints(FaceNetworks& networks, const fsm::Image& image, const FaceBox& box) {
  FoundFace face;
  const glm::vec2 line = box.eyes[1] - box.eyes[0];
  face.crop = {box.centre, kRoom * std::max(box.size.x, box.size.y), std::atan2(line.y, line.x)};
  constexpr std::size_t kEyes[] = {33, 263};  // outer corners
  // The first look says where the face is, the second sees it upright and as large as in training.
  for (int look = 0; look < 3; ++look) {
    networks.landmarks.Run(face.crop.Sample(image, kPointsPixels, 0, 1));
    const auto raw = networks.landmarks.output(0);
    const float logit = networks.landmarks.output(1)[0];
    face.certainty = 1 / (1 + std::exp(-logit));
    face.points.clear();
    glm::vec2 low(1e9F), high(-1e9F);
    for (std::size_t i = 0; i < kNetworkPoints; ++i) {
      const glm::vec2 at =
          glm::vec2(raw[3 * i], raw[3 * i + 1]) / static_cast<float>(kPointsPixels);
      const glm::vec2 p = face.crop.ToPicture(at);
      low = glm::min(low, at);
      high = glm::max(high, at);
      face.points.emplace_back(p, -raw[3 * i + 2] / kPointsPixels * face.crop.side);
    }
    if (look == 2) break;
    const glm::vec2 eyes = glm::vec2(face.points[kEyes[1]]) - glm::vec2(face.points[kEyes[0]]);
    const glm::vec2 extent = (high - low) * face.crop.side;
    face.crop = {face.crop.ToPicture((low + high) * 0.5F), kRoom * std::max(extent.x, extent.y),
                 std::atan2(eyes.y, eyes.x)};
  }
  return face;
}

}  // namespace facefit

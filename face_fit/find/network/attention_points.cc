#include "face_fit/find/network/attention_points.h"

#include "face_fit/find/network/face_finder.h"
#include "face_fit/find/network/face_networks.h"

namespace facefit {
namespace {

/// The outputs: 468 points (x, y, z), then points (x, y) of lips, eyes and irises, all in pixels of
/// the input, and how certain it is that there is a face (a logit).
enum AttentionOutput : std::size_t {
  kPoints,
  kLips,
  kRightEye,
  kLeftEye,
  kRightIris,
  kLeftIris,
  kCertainty
};

// The points of the face that the network refines, in the order of its outputs
// (mediapipe/modules/face_landmark/tensors_to_face_landmarks_with_attention.pbtxt).
constexpr PointIndex kLipPoints[] = {
    // outer border: the lower lip with both corners, the upper without
    61, 146, 91, 181, 84, 17, 314, 405, 321, 375, 291, 185, 40, 39, 37, 0, 267, 269, 270, 409,
    // inner border
    78, 95, 88, 178, 87, 14, 317, 402, 318, 324, 308, 191, 80, 81, 82, 13, 312, 311, 310, 415,
    // a row inside the outer border
    76, 77, 90, 180, 85, 16, 315, 404, 320, 307, 306, 184, 74, 73, 72, 11, 302, 303, 304, 408,
    // a row outside the inner border
    62, 96, 89, 179, 86, 15, 316, 403, 319, 325, 292, 183, 42, 41, 38, 12, 268, 271, 272, 407};
constexpr PointIndex kRightEyePoints[] = {
    33,  7,   163, 144, 145, 153, 154, 155, 133,
    246, 161, 160, 159, 158, 157, 173,  // the lids' edge
    130, 25,  110, 24,  23,  22,  26,  112, 243,
    247, 30,  29,  27,  28,  56,  190,  // around it
    226, 31,  228, 229, 230, 231, 232, 233, 244,
    113, 225, 224, 223, 222, 221, 189,            // and again
    35,  124, 46,  53,  52,  65,                  // under the brow
    143, 111, 117, 118, 119, 120, 121, 128, 245,  // under the eye
    156, 70,  63,  105, 66,  107, 55,  193};      // the brow
constexpr PointIndex kLeftEyePoints[] = {
    263, 249, 390, 373, 374, 380, 381, 382, 362, 466, 388, 387, 386, 385, 384, 398, 359, 255,
    339, 254, 253, 252, 256, 341, 463, 467, 260, 259, 257, 258, 286, 414, 446, 261, 448, 449,
    450, 451, 452, 453, 464, 342, 445, 444, 443, 442, 441, 413, 265, 353, 276, 283, 282, 295,
    372, 340, 346, 347, 348, 349, 350, 357, 465, 383, 300, 293, 334, 296, 336, 285, 417};

}  // namespace

vm::Result<AttentionNetwork> AttentionNetwork::Load(const std::string& folder) {
  constexpr std::size_t kLipNumbers = 2 * std::size(kLipPoints),
                        kEyeNumbers = 2 * std::size(kRightEyePoints), kIrisNumbers = 2 * 5;
  auto network = ReadFaceMeshNetwork(
      folder, "face_landmark_with_attention.tflite", kLandmarkInputPixels,
      {3 * kNetworkPoints, kLipNumbers, kEyeNumbers, kEyeNumbers, kIrisNumbers, kIrisNumbers, 1});
  if (!network) return std::unexpected(network.error());
  return AttentionNetwork(std::move(*network));
}

AttentiveFace AttentionNetwork::Find(const fsm::Image& image, const NetworkCrop& crop) {
  network_.Run(crop.Sample(image, kLandmarkInputPixels, 0, 1));
  const auto pixel = [&](AttentionOutput output, std::size_t i) {
    const auto xy = network_.output(output);
    return crop.ToImage(glm::vec2(xy[2 * i], xy[2 * i + 1]) / float{kLandmarkInputPixels});
  };
  AttentiveFace found;
  found.face.crop = crop;
  found.face.certainty = Probability(network_.output(kCertainty)[0]);
  found.face.points = PointsInImage(PointsOf(network_.output(kPoints)), crop);
  const auto refine = [&](AttentionOutput output, std::span<const PointIndex> points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::vec2 at = pixel(output, i);
      found.face.points[points[i]].x = at.x;
      found.face.points[points[i]].y = at.y;
    }
  };
  refine(kLips, kLipPoints);
  refine(kRightEye, kRightEyePoints);
  refine(kLeftEye, kLeftEyePoints);
  for (std::size_t i = 0; i < found.iris.right.size(); ++i) {
    found.iris.right[i] = pixel(kRightIris, i);
    found.iris.left[i] = pixel(kLeftIris, i);
  }
  return found;
}

}  // namespace facefit

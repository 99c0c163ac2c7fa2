#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "face_fit/find/network/attention_points.h"
#include "fsm/base/side.h"
#include "fsm/rig/angles.h"
#include "vm_protocol/core/result.h"

namespace facetrack {

/// What is followed: the network's points, then the middles of the right and the left iris.
inline constexpr std::size_t kPoints = facefit::kNetworkPoints + 2;
inline constexpr std::size_t kIris = facefit::kNetworkPoints;
using Points = std::vector<glm::vec3>;  ///< kPoints of them, millimetres

/// Returns the rotation of a FaceState::head_rotation; fsm::HeadRotationOf is its inverse.
glm::mat3 TurnOf(const fsm::Angles& degrees);

/// Something a face does, and what the network sees of it.
struct Channel {
  enum class Kind { kUnit, kGazeDown, kGazeRight };
  Kind kind = Kind::kUnit;
  int unit = 0;                ///< of kUnit: FACS
  std::string side;            ///< "L", "R" or "" for both: the person's own
  std::vector<float> doses;    ///< rising, without 0: strengths, or degrees of the gaze
  std::vector<Points> motion;  ///< at each dose, of all points, in the head's frame
  /// Along each of SeenFace::variations: by how much (rms) one head moves otherwise than another,
  /// at a dose of usual().
  std::vector<float> varies;

  std::string Name() const;  ///< "12L", "26", "gaze_downL"
  /// Between doses straight, and on beyond the last ones.
  glm::vec3 At(std::size_t point, float dose) const;
  /// By how much one more of the dose moves a point.
  glm::vec3 Slope(std::size_t point, float dose) const;
  /// The size of a dose that is nothing unusual.
  float usual() const { return kind == Kind::kUnit ? 1 : 20; }
  float lowest() const { return kind == Kind::kUnit ? 0 : 1.5F * doses.front(); }
  float highest() const { return (kind == Kind::kUnit ? 1.2F : 1.5F) * doses.back(); }

 private:
  /// The straight piece a dose lies on: its two ends, where -1 is 0.
  std::array<int, 2> Piece(float dose) const;
};

/// A face as the network sees it: how its points lie on a usual head at rest, how they slide over
/// it as it turns, what the units make of them, how sure they are, and in which ways heads differ
/// in what units make of them. A table that
/// face_track_learn makes of pictures of our heads (docs/tracking.md). Sizes are those of a head
/// whose outer corners of the eyes lie kEyesApart mm apart.
struct SeenFace {
  static constexpr float kEyesApart = 90;
  static constexpr std::size_t kSlides = 9;

  Points rest;
  std::vector<float> depth;   ///< that the network gives each point on a usual head, mm
  std::vector<float> spread;  ///< mm by which points of other heads lie otherwise as they turn
  std::vector<std::array<glm::vec2, kSlides>> slide;
  std::vector<Channel> channels;
  static constexpr std::size_t kMostVariations = 200;
  /// Ways in which heads differ in how they move, each of 1 mm (rms over the points), x and y.
  std::vector<std::vector<glm::vec2>> variations;
  std::vector<float> remainder;  ///< mm (rms) by which they differ in other ways, a point each

  /// How far a point is seen from where it is, mm to the right and up on a head that is seen
  /// turned so many degrees down and to the right.
  glm::vec2 Slide(std::size_t point, float down, float right) const;
  static std::array<float, kSlides> SlideTerms(float down, float right);
  /// The channel of that name; throws std::out_of_range.
  std::size_t Find(std::string_view name) const;

  static vm::Result<SeenFace> Parse(const std::string& name, std::string_view text);
  std::string Print() const;
  /// The table the programs carry.
  static const SeenFace& Shipped();
};

/// Of each point that on the other side of the face, itself in the middle: pairs that lie nearest
/// to each other's mirrored places in these faces, whose lips are shut in some and open in others.
std::vector<std::size_t> MirroredPoints(const std::vector<Points>& faces);

}  // namespace facetrack

#include "face_track/follow/tracker.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "face_fit/find/network/face_finder.h"

namespace facetrack {
namespace {

constexpr float kSameAfterCut = 0.75F;  // likeness: another head has reached 0.71
constexpr float kStranger = 3;  // mm by which a face misses more than its own when it is another's
constexpr float kNoFace = 8;    // mm: what fits so badly is no face
constexpr float kJawDegrees = 12;  // of unit 26 (fsm/head/tables/action_units.txt)

Sighting SightingOf(const facefit::AttentiveFace& found, const Lens& lens, const Pose& pose) {
  Sighting sighting{.places = PlacesOf(found), .depth = {}};
  const float mm_per_pixel = -pose.place.z / lens.focal;
  for (const glm::vec3& p : found.face.points) sighting.depth.push_back(p.z * mm_per_pixel);
  return sighting;
}

/// Between the edges of an eye's lids, the mean of three places.
float LidGap(const Points& points, fsm::Side side) {
  const auto outline = facefit::point::kEyeOutline[side];
  float gap = 0;
  for (const std::size_t k : {0U, 1U, 2U}) {
    gap += points[outline[facefit::kUpperMiddle - 1 + k]].y -
           points[outline[facefit::kLowerMiddle + 1 - k]].y;
  }
  return gap / 3;
}

}  // namespace

Tracker::Tracker(facefit::FaceNetworks& networks, facefit::AttentionNetwork& attention,
                 const SeenFace& face, const Settings& settings)
    : networks_(networks), attention_(attention), face_(face), settings_(settings) {}

std::optional<Tracker::Candidate> Tracker::LookAt(const fsm::Image& picture,
                                                  facefit::AttentiveFace found, const Doing* start,
                                                  const Points& rest, FrameFit::What what) {
  constexpr int kLooks = 3;  // each nearer to how the table was made
  Doing doing = start ? *start : fit_->Guess(PlacesOf(found));
  for (int look = 0;; ++look) {
    if (found.face.certainty < facefit::kCertainFace) return std::nullopt;
    doing = fit_->Solve(rest, PlacesOf(found), doing, what);
    const facefit::NetworkCrop crop = CropOf(fit_->lens(), doing.pose);
    const bool moved = glm::distance(crop.centre, found.face.crop.centre) > 0.03F * crop.size ||
                       std::abs(crop.angle_rad - found.face.crop.angle_rad) > 0.05F ||
                       std::abs(crop.size / found.face.crop.size - 1) > 0.05F;
    if (!moved || look + 1 == kLooks) break;
    found = attention_.Find(picture, crop);
  }
  if (settings_.careful) {
    found = LookAround(picture, found);
    doing = fit_->Solve(rest, PlacesOf(found), doing, what);
  }
  if (doing.miss > kNoFace) return std::nullopt;
  return Candidate{std::move(found), std::move(doing)};
}

facefit::AttentiveFace Tracker::LookAround(const fsm::Image& picture,
                                           const facefit::AttentiveFace& found) {
  constexpr float kTurned = 0.03F, kScaled = 0.02F;  // radians; parts of the crop's size
  constexpr glm::vec2 kShifted(0.012F, -0.006F);     // in the same
  facefit::AttentiveFace mean = found;
  for (const float side : {1.0F, -1.0F}) {
    facefit::NetworkCrop crop = found.face.crop;
    crop.centre += side * crop.size * kShifted;
    crop.size *= 1 + side * kScaled;
    crop.angle_rad += side * kTurned;
    const facefit::AttentiveFace other = attention_.Find(picture, crop);
    const auto add = [](auto& to, const auto& from, const auto& before) {
      for (std::size_t i = 0; i < to.size(); ++i) to[i] += (from[i] - before[i]) / 3.0F;
    };
    add(mean.face.points, other.face.points, found.face.points);
    add(mean.iris.right, other.iris.right, found.iris.right);
    add(mean.iris.left, other.iris.left, found.iris.left);
  }
  return mean;
}

std::optional<Tracker::Candidate> Tracker::Find(const fsm::Image& picture, bool cut) {
  constexpr std::size_t kMostFaces = 10;
  std::vector<facefit::AttentiveFace> faces;  // largest first
  for (const auto& face : facefit::FindFaces(networks_, picture)) {
    if (faces.size() == kMostFaces) break;
    if (face.certainty < facefit::kCertainFace) continue;
    faces.push_back(attention_.Find(picture, face.crop));
  }
  std::optional<Candidate> nearest;
  float most_like = -1;
  for (std::size_t i = 0; person_ && i < faces.size(); ++i) {
    auto candidate =
        LookAt(picture, faces[i], nullptr, person_->rest, FrameFit::What::kPoseAndDoses);
    if (!candidate) continue;
    const FaceLook look(picture, CropOf(fit_->lens(), candidate->doing.pose));
    const float like = image_fit_->Solve(person_->rest, look, candidate->doing).like;
    const bool stranger =
        cut ? like < kSameAfterCut
            : like < ImageFit::kAlike && candidate->doing.miss > person_->miss + kStranger;
    if (stranger) continue;
    if (like > most_like) nearest = std::move(candidate), most_like = like;
  }
  if (nearest || faces.size() < settings_.which) return nearest;
  auto stranger =
      LookAt(picture, faces[settings_.which - 1], nullptr, face_.rest, FrameFit::What::kPose);
  if (stranger) Forget();
  return stranger;
}

void Tracker::Forget() {
  person_.reset();
  image_fit_.reset();
  unlike_ = 0;
}

std::optional<Tracker::Waiting> Tracker::See(const fsm::Image& picture, double ms, bool cut) {
  constexpr int kLookEvery = 3, kMostUnlike = 5;
  std::optional<Candidate> seen;
  if (last_ && !cut && unlike_ < kMostUnlike) {
    seen = LookAt(picture, attention_.Find(picture, CropOf(fit_->lens(), last_->pose)), &*last_,
                  person_ ? person_->rest : face_.rest,
                  person_ ? FrameFit::What::kPoseAndDoses : FrameFit::What::kPose);
  }
  if (!seen) {
    last_.reset();
    unlike_ = 0;
    if (cut) unseen_ = 0;
    if (unseen_++ % kLookEvery == 0) seen = Find(picture, cut);
    if (!seen) return std::nullopt;
  }
  unseen_ = 0;
  return Waiting{.ms = ms,
                 .certainty = seen->face.face.certainty,
                 .seen = SightingOf(seen->face, fit_->lens(), seen->doing.pose),
                 .look = FaceLook(picture, CropOf(fit_->lens(), seen->doing.pose)),
                 .doing = std::move(seen->doing)};
}

Doing Tracker::Follow(const Sighting& seen, const FaceLook& look, const Doing& start) {
  // Doses found together with a turn take part of it, so the turn comes first and by itself.
  Doing doing = start;
  std::ranges::fill(doing.doses, 0.0F);
  doing = fit_->Solve(person_->rest, seen.places, doing, FrameFit::What::kPose);
  const auto [pose, like] = image_fit_->Solve(person_->rest, look, doing);
  const bool alike = like >= ImageFit::kAlike;
  unlike_ = alike || start.miss <= person_->miss + kStranger ? 0 : unlike_ + 1;
  if (!alike) return start;
  doing.pose = pose;
  doing.doses = start.doses;
  return fit_->Solve(person_->rest, seen.places, doing, FrameFit::What::kDoses);
}

std::vector<FaceLine> Tracker::Look(const fsm::Image& filmed, double ms) {
  if (!fit_) fit_.emplace(face_, Lens::Of(filmed.width, filmed.height, settings_.field_degrees));
  std::vector<FaceLine> lines;
  const bool cut = cut_finder_.IsCut(filmed);
  if (cut) lines = Finish();
  const bool follows = last_ && !cut;
  if (!follows) noise_filter_.Forget();
  const fsm::Image& picture =
      follows ? noise_filter_.Filter(filmed, CropOf(fit_->lens(), last_->pose)) : filmed;
  auto seen = See(picture, ms, cut);
  const bool over = !seen || waiting_.size() >= kMostWaiting ||
                    (!waiting_.empty() && ms - waiting_.front().ms >= settings_.settle_ms);
  if (over && !waiting_.empty()) {
    lines = Finish();
    if (seen) {  // now that the person is known
      seen->doing =
          fit_->Solve(person_->rest, seen->seen.places, seen->doing, FrameFit::What::kPoseAndDoses);
    }
  }
  if (!seen) {
    lines.push_back({.ms = ms,
                     .units = std::vector<float>(face_.channels.size(), 0),
                     .points = {},
                     .places = {}});
    last_.reset();
    filters_.clear();
  } else if (person_) {
    last_ = Follow(seen->seen, seen->look, seen->doing);
    lines.push_back(LineOf(*seen, *last_));
  } else {
    last_ = seen->doing;
    waiting_.push_back(std::move(*seen));
  }
  return lines;
}

std::vector<FaceLine> Tracker::Finish() {
  std::vector<FaceLine> lines;
  if (waiting_.empty()) return lines;
  std::vector<Sighting> pictures;
  for (const Waiting& w : waiting_) pictures.push_back(w.seen);
  person_ = Meet(*fit_, pictures);
  ++people_;
  filters_.clear();
  std::vector<Doing> doings;
  for (const Waiting& w : waiting_) {
    doings.push_back(fit_->Solve(person_->rest, w.seen.places, w.doing, FrameFit::What::kPose));
  }
  // The template is the picture that is most like what was taken for the rest; where there is
  // noise, the mean of the half of them that are.
  std::vector<std::size_t> usual(doings.size());
  std::iota(usual.begin(), usual.end(), 0U);
  std::ranges::sort(usual, {}, [&](std::size_t i) { return std::pair(doings[i].miss, i); });
  usual.resize(noise_filter_.IsNoisy() ? (usual.size() + 1) / 2 : 1);
  std::vector<ImageFit::View> views;
  for (const std::size_t i : usual) views.push_back({waiting_[i].look, doings[i].pose});
  image_fit_.emplace(face_, fit_->lens(), person_->rest, views);
  for (const Waiting& w : waiting_) {
    last_ =
        Follow(w.seen, w.look,
               fit_->Solve(person_->rest, w.seen.places, w.doing, FrameFit::What::kPoseAndDoses));
    lines.push_back(LineOf(w, *last_));
  }
  waiting_.clear();
  return lines;
}

FaceLine Tracker::LineOf(const Waiting& waiting, const Doing& doing) {
  FaceLine line{.ms = waiting.ms,
                .person = people_,
                .certainty = waiting.certainty,
                .miss = doing.miss,
                .head = fsm::HeadRotationOf(doing.pose.turn),
                .place = doing.pose.place,
                .units = doing.doses,
                .points = fit_->OnFace(person_->rest, waiting.seen.places, doing),
                .places = waiting.seen.places};
  for (const fsm::Side side : fsm::kSides) {
    line.lid[static_cast<std::size_t>(side)] = std::clamp(
        LidGap(line.points, side) / std::max(LidGap(person_->rest, side), 1.0F), 0.0F, 2.0F);
  }
  line.lips = LipsOf(line.points, person_->rest);
  SmoothLine(line);
  for (const fsm::Side side : fsm::kSides) {
    const std::string name = side == fsm::Side::kRight ? "R" : "L";
    line.gaze[static_cast<std::size_t>(side)] = {line.units[face_.Find("gaze_down" + name)],
                                                 line.units[face_.Find("gaze_right" + name)]};
  }
  line.jaw = kJawDegrees * line.units[face_.Find("26")];
  return line;
}

void Tracker::SmoothLine(FaceLine& line) {
  const double seconds = (line.ms - last_ms_) / 1000;
  last_ms_ = line.ms;
  if (settings_.smooth <= 0) return;
  std::vector<float*> values;
  std::vector<std::array<float, 2>> kinds;  // cutoff in Hz, rise
  for (float& v : line.head) values.push_back(&v), kinds.push_back({4, 0.3F});
  for (int k = 0; k < 3; ++k) values.push_back(&line.place[k]), kinds.push_back({4, 0.1F});
  for (float& v : line.lid) values.push_back(&v), kinds.push_back({8, 8});
  for (float& v : line.lips) values.push_back(&v), kinds.push_back({10, 0.3F});
  for (std::size_t c = 0; c < line.units.size(); ++c) {
    values.push_back(&line.units[c]);
    const bool unit = face_.channels[c].kind == Channel::Kind::kUnit;
    kinds.push_back(unit ? std::array<float, 2>{5, 5} : std::array<float, 2>{5, 0.3F});
  }
  if (filters_.empty()) {
    for (const auto& [cutoff, rise] : kinds) filters_.emplace_back(cutoff / settings_.smooth, rise);
  }
  for (std::size_t k = 0; k < values.size(); ++k) *values[k] = filters_[k](*values[k], seconds);
}

}  // namespace facetrack

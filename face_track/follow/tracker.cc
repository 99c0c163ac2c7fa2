#include "face_track/follow/tracker.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace facetrack {
namespace {

constexpr float kStranger = 3;    // mm by which a face misses more than its own when it is another's
constexpr float kNoFace = 8;      // mm: what fits so badly is no face
constexpr float kJawDegrees = 12; // of unit 26 (fsm/head/tables/action_units.txt)

Sighting SightingOf(const facefit::AttentiveFace& found, const Lens& lens, const Pose& pose) {
  Sighting sighting{.places = PlacesOf(found), .depth = {}};
  const float mm_per_pixel = -pose.place.z / lens.focal;
  for (const glm::vec3& p : found.face.points) sighting.depth.push_back(p.z * mm_per_pixel);
  return sighting;
}

/// Between the edges of an eye's lids, the mean of three places.
float LidGap(const Points& points, fsm::Side side) {
  const auto outline = facefit::EyeOutline(side);
  float gap = 0;
  for (const std::size_t k : {0U, 1U, 2U}) {
    gap += points[outline[facefit::kUpperMiddle - 1 + k]].y -
           points[outline[facefit::kLowerMiddle + 1 - k]].y;
  }
  return gap / 3;
}

}  // namespace

Tracker::Tracker(facefit::FaceNetworks& networks, facefit::Network& attention, const SeenFace& face,
                 const Settings& settings)
    : networks_(networks), attention_(attention), face_(face), settings_(settings) {}

bool Tracker::IsCut(const fsm::Image& picture) {
  constexpr int kCells = 24, kStep = 3;
  constexpr float kCut = 36;  // of 255, between pictures that follow each other
  std::vector<float> thumbnail(kCells * kCells, 0);
  for (int y = 0; y < kCells * kStep; ++y) {
    for (int x = 0; x < kCells * kStep; ++x) {
      const int px = x * picture.width / (kCells * kStep), py = y * picture.height / (kCells * kStep);
      const auto at = 4 * (static_cast<std::size_t>(py) * static_cast<std::size_t>(picture.width) +
                           static_cast<std::size_t>(px));
      const float sum = static_cast<float>(picture.rgba[at] + picture.rgba[at + 1] + picture.rgba[at + 2]);
      thumbnail[static_cast<std::size_t>(y / kStep * kCells + x / kStep)] += sum / (3 * kStep * kStep);
    }
  }
  float off = 0;
  for (std::size_t i = 0; i < thumbnail_.size(); ++i) off += std::abs(thumbnail[i] - thumbnail_[i]);
  thumbnail_ = std::move(thumbnail);
  return off > kCut * kCells * kCells;
}

std::optional<facefit::AttentiveFace> Tracker::Find(const fsm::Image& picture) {
  const auto boxes = facefit::FindFaces(networks_, picture);
  if (boxes.empty()) return std::nullopt;
  const auto face = facefit::FindPoints(networks_, picture, boxes.front());
  if (face.certainty < facefit::kCertainFace) return std::nullopt;
  return facefit::FindAttentivePoints(attention_, picture, face.crop);
}

std::optional<Tracker::Waiting> Tracker::See(const fsm::Image& picture, double ms, bool cut) {
  constexpr int kLookEvery = 3;
  const bool met = person_.has_value();
  const Points& rest = met ? person_->rest : face_.rest;
  std::optional<facefit::AttentiveFace> found;
  if (last_ && !cut) {
    found = facefit::FindAttentivePoints(attention_, picture, CropOf(fit_->lens(), last_->pose));
    if (found->face.certainty < facefit::kCertainFace) found.reset();
  }
  bool anew = false;
  if (!found) {
    last_.reset();
    if (!cut && unseen_++ % kLookEvery != 0) return std::nullopt;
    found = Find(picture);
    if (!found) return std::nullopt;
    anew = true;
  }
  Doing doing = last_ ? *last_ : fit_->Guess(PlacesOf(*found));
  // The network is shown the same part of a head as when the table was made; where the head has
  // moved on since the last picture, or was just found, it looks once more.
  for (int look = 0;; ++look) {
    doing = fit_->Solve(rest, PlacesOf(*found), doing, met);
    const facefit::Crop crop = CropOf(fit_->lens(), doing.pose);
    const bool moved =
        glm::distance(crop.centre, found->face.crop.centre) > 0.03F * crop.side ||
        std::abs(crop.angle - found->face.crop.angle) > 0.05F ||
        std::abs(crop.side / found->face.crop.side - 1) > 0.05F;
    if (!moved || look == 2) break;
    found = facefit::FindAttentivePoints(attention_, picture, crop);
  }
  if (found->face.certainty < facefit::kCertainFace || doing.miss > kNoFace) {
    last_.reset();
    return std::nullopt;
  }
  if (anew && met && doing.miss > person_->miss + kStranger) {
    person_.reset();
    doing = fit_->Solve(face_.rest, PlacesOf(*found), fit_->Guess(PlacesOf(*found)), false);
  }
  unseen_ = 0;
  last_ = std::move(doing);
  Waiting waiting{.ms = ms,
                  .certainty = found->face.certainty,
                  .seen = SightingOf(*found, fit_->lens(), last_->pose),
                  .doing = {}};
  if (person_) waiting.doing = last_;
  return waiting;
}

std::vector<FaceLine> Tracker::Look(const fsm::Image& picture, double ms) {
  if (!fit_) fit_.emplace(face_, Lens::Of(picture.width, picture.height, settings_.field_degrees));
  std::vector<FaceLine> lines;
  const bool cut = IsCut(picture);
  if (cut) lines = Finish();
  auto seen = See(picture, ms, cut);
  const bool over = !seen || waiting_.size() >= kMostWaiting ||
                    (!waiting_.empty() && ms - waiting_.front().ms >= settings_.settle_ms);
  if (over && !waiting_.empty()) lines = Finish();
  if (!seen) {
    lines.push_back({.ms = ms, .units = std::vector<float>(face_.channels.size(), 0), .points = {}});
    last_.reset();
    filters_.clear();
  } else if (person_) {
    lines.push_back(LineOf(*seen));
  } else {
    waiting_.push_back(std::move(*seen));
  }
  return lines;
}

std::vector<FaceLine> Tracker::Finish() {
  std::vector<FaceLine> lines;
  if (waiting_.empty()) return lines;
  std::vector<Sighting> pictures;
  for (const Waiting& w : waiting_) pictures.push_back(*w.seen);
  person_ = Meet(*fit_, pictures);
  ++people_;
  filters_.clear();
  last_.reset();
  for (const Waiting& w : std::exchange(waiting_, {})) lines.push_back(LineOf(w));
  return lines;
}

FaceLine Tracker::LineOf(const Waiting& waiting) {
  const auto& places = waiting.seen->places;
  last_ = waiting.doing ? *waiting.doing
                        : fit_->Solve(person_->rest, places,
                                      last_ ? *last_ : fit_->Guess(places), true);
  FaceLine line{.ms = waiting.ms,
                .person = people_,
                .certainty = waiting.certainty,
                .miss = last_->miss,
                .head = AnglesOf(last_->pose.turn),
                .place = last_->pose.place,
                .units = last_->doses,
                .points = fit_->OnFace(person_->rest, places, *last_)};
  for (const fsm::Side side : fsm::kSides) {
    line.lid[static_cast<std::size_t>(side)] = std::clamp(
        LidGap(line.points, side) / std::max(LidGap(person_->rest, side), 1.0F), 0.0F, 2.0F);
  }
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

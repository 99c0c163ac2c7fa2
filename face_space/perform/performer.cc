#include "face_space/perform/performer.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <set>
#include <utility>

#include "fsm/base/random.h"
#include "fsm/rig/unit_combiner.h"

namespace facespace {
namespace {

constexpr double kRestMs = 400, kOnsetMs = 450, kHoldMs = 400, kOffsetMs = 500, kLagMs = 60;

/// Slow, fast, slow.
double Smooth(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * s * (10 + s * (6 * s - 15));
}
/// How strong a unit is `ms` after an expression began.
double Envelope(double ms) {
  if (ms < kOnsetMs) return Smooth(ms / kOnsetMs);
  return 1 - Smooth((ms - kOnsetMs - kHoldMs) / kOffsetMs);
}

/// Four vertices evenly along each lid, where it turns most.
std::vector<std::uint32_t> LidSites(const fsm::RigData& rig) {
  std::vector<std::uint32_t> sites;
  for (const fsm::Side side : fsm::kSides) {
    for (const bool upper : {true, false}) {
      const auto part = [upper](const fsm::LidRig::Vertex& v) {
        return upper ? v.point.upper : v.point.lower;
      };
      std::vector<fsm::LidRig::Vertex> lid;
      for (const fsm::LidRig::Vertex& v : rig.lids.vertices) {
        if (v.side == side && part(v) > 0.5F && v.point.opening > 0.4F) lid.push_back(v);
      }
      std::ranges::stable_sort(lid,
                               [&](const auto& a, const auto& b) { return part(a) > part(b); });
      lid.resize(lid.size() / 3);
      std::ranges::stable_sort(lid, [&](const auto& a, const auto& b) {
        return std::abs(rig.rest[a.vertex].x) < std::abs(rig.rest[b.vertex].x);
      });
      for (std::size_t k = 0; k < 4 && !lid.empty(); ++k) {
        sites.push_back(lid[(2 * k + 1) * lid.size() / 8].vertex);
      }
    }
  }
  return sites;
}

}  // namespace

HeadSites SitesOf(const fsm::Head& head, std::size_t count) {
  const fsm::RigData& rig = head.rig().data();
  const std::vector<std::uint32_t> skin = FaceSkin(head);
  HeadSites sites;
  const auto far = [&](std::uint32_t a, std::uint32_t b) {
    const glm::vec3 p = rig.rest[a];
    const bool mouth = p.y < -8 && std::abs(p.x) < 45;
    // Both lips' edges lie at one place at rest and move apart.
    const bool lips = std::abs(rig.weights[a].above_mouth - rig.weights[b].above_mouth) > 0.5F;
    return (mouth ? 1.5F : 1.0F) * glm::distance(p, rig.rest[b]) + (lips ? 2.0F : 0.0F);
  };
  sites.vertices = LidSites(rig);
  // The skin farthest from all that are chosen, again and again; lids' folds are left out.
  std::vector<std::uint32_t> candidates;
  for (const std::uint32_t i : skin) {
    if (rig.weights[i].free > 0.7F && rig.rest[i].x > -0.5F) candidates.push_back(i);
  }
  std::vector<float> distance(candidates.size(), 1e9F);
  const auto keep_off = [&](std::uint32_t site) {
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      distance[k] = std::min(distance[k], far(candidates[k], site));
    }
  };
  for (const std::uint32_t lid : sites.vertices) keep_off(lid);
  while (sites.vertices.size() < count) {
    const auto farthest = std::ranges::max_element(distance) - distance.begin();
    const std::uint32_t site = candidates[static_cast<std::size_t>(farthest)];
    sites.vertices.push_back(site);
    keep_off(site);
    const glm::vec3 image = rig.rest[site] * glm::vec3(-1, 1, 1);
    if (image.x > -3 || sites.vertices.size() == count) continue;
    const auto away = [&](std::uint32_t i) {
      const float lip = rig.weights[i].above_mouth - rig.weights[site].above_mouth;
      return glm::distance(rig.rest[i], image) + std::abs(lip);
    };
    sites.vertices.push_back(*std::ranges::min_element(skin, {}, away));
  }
  for (std::size_t k = 0; k < sites.vertices.size(); ++k) {
    sites.names.push_back(fmt::format("s{:03}", k + 1));
    sites.places.emplace(sites.names.back(), rig.rest[sites.vertices[k]]);
  }
  return sites;
}

Eigen::VectorXd SitesIn(const fsm::Head& head, const HeadSites& sites,
                        const fsm::FaceState& state) {
  fsm::HeadVertices vertices;
  head.Evaluate(state, vertices);
  Eigen::VectorXd places(3 * static_cast<Eigen::Index>(sites.vertices.size()));
  for (std::size_t k = 0; k < sites.vertices.size(); ++k) {
    const glm::vec3 p = vertices.position[sites.vertices[k]];
    places.segment<3>(3 * static_cast<Eigen::Index>(k)) =
        Eigen::Vector3f(p.x, p.y, p.z).cast<double>();
  }
  return places;
}

Recording RecordingOf(const UnitTrack& track, const fsm::Head& head, const HeadSites& sites) {
  Recording out{.name = track.name, .markers = sites.names, .ms = track.ms, .places = {}};
  out.places.resize(3 * static_cast<Eigen::Index>(sites.names.size()),
                    static_cast<Eigen::Index>(track.looks.size()));
  for (std::size_t t = 0; t < track.looks.size(); ++t) {
    fsm::FaceState state;
    state.asymmetry = 0;
    state.au = track.looks[t].au;
    state.gaze = track.looks[t].gaze;
    out.places.col(static_cast<Eigen::Index>(t)) = SitesIn(head, sites, state);
  }
  return out;
}

fsm::FaceState StateOf(const std::vector<Label>& units) {
  fsm::FaceState state;
  state.asymmetry = 0;
  for (const Label& label : units) {
    const auto unit = static_cast<std::size_t>(std::stoul(label.unit));
    for (const fsm::Side side : fsm::kSides)
      state.au[side][unit] = static_cast<float>(label.strength);
  }
  return state;
}

Recording Perform(const Performer& settings, const fsm::Head& head, const HeadSites& sites,
                  const std::string& name, const std::vector<Label>& units) {
  const std::uint64_t seed = fsm::HashOf(name) ^ settings.seed;
  const auto chance = [seed](std::uint64_t stream, std::int64_t i) {
    return fsm::RandomAt(seed, stream, i);
  };
  const double once = kOnsetMs + kHoldMs + kOffsetMs + kLagMs + kRestMs;
  const double length = kRestMs + settings.times * once;
  Recording out{.name = name, .markers = sites.names, .ms = {}, .places = {}};
  const auto frames = static_cast<Eigen::Index>(length * settings.rate / 1000);
  out.places.resize(3 * static_cast<Eigen::Index>(sites.names.size()), frames);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const double ms = 1000.0 * static_cast<double>(t) / settings.rate;
    out.ms.push_back(ms);
    std::vector<Label> now = units;
    const double since = std::fmod(std::max(0.0, ms - kRestMs), once);
    for (std::size_t u = 0; u < now.size(); ++u) {
      const double lag = kLagMs * (0.5 + 0.5 * chance(1, static_cast<std::int64_t>(u)));
      now[u].strength *= ms < kRestMs || since < lag ? 0 : Envelope(since - lag);
    }
    Eigen::VectorXd places = SitesIn(head, sites, StateOf(now));
    // The head wanders: each angle and place by a slow wave of its own.
    const auto wave = [&](std::uint64_t k) {
      const double period = 2000 + 900 * chance(2, static_cast<std::int64_t>(k));
      return std::sin(2 * std::numbers::pi *
                      (ms / period + chance(3, static_cast<std::int64_t>(k))));
    };
    const double rad = settings.head_degrees * std::numbers::pi / 180;
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(rad * wave(0), Eigen::Vector3d::UnitX()) *
                                  Eigen::AngleAxisd(rad * wave(1), Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(rad * wave(2), Eigen::Vector3d::UnitZ()))
                                     .toRotationMatrix();
    const Eigen::Vector3d shift = settings.head_mm * Eigen::Vector3d(wave(3), wave(4), wave(5));
    for (Eigen::Index m = 0; m < places.size(); m += 3) {
      const Eigen::Vector3d moved = turn * places.segment<3>(m) + shift;
      for (Eigen::Index k = 0; k < 3; ++k) {
        // Three draws come near enough to a normal distribution; each has a variance of 1/3.
        const std::int64_t i = 3 * (t * places.size() + m + k);
        places[m + k] =
            moved[k] + settings.noise_mm * (chance(4, i) + chance(4, i + 1) + chance(4, i + 2));
      }
    }
    out.places.col(t) = places;
  }
  return out;
}

std::vector<std::string> PaperUnits() {
  return {"1", "2", "4", "5", "6", "9", "12", "15", "17", "20", "26"};
}

std::vector<std::vector<Label>> Mixtures(const std::vector<std::string>& units, std::size_t count,
                                         const fsm::Head& head, bool apart, std::uint64_t seed) {
  const fsm::RigData& rig = head.rig().data();
  const fsm::UnitCombiner combiner(rig.units, rig.asymmetry_seed);
  std::vector<std::vector<Label>> out;
  std::set<std::set<std::string>> seen;
  const auto draw = [seed](std::uint64_t stream, std::int64_t i, std::size_t below) {
    const double share = 0.5 + 0.5 * fsm::RandomAt(seed, stream, i);
    return std::min(below - 1, static_cast<std::size_t>(share * static_cast<double>(below)));
  };
  for (std::int64_t tries = 0; out.size() < count && tries < 100'000; ++tries) {
    const std::size_t parts = std::min(units.size(), 2 + draw(11, tries, 3));
    std::set<std::string> chosen;
    for (std::int64_t k = 0; chosen.size() < parts; ++k) {
      chosen.insert(units[draw(12, 100 * tries + k, units.size())]);
    }
    std::vector<Label> mixture;
    for (const std::string& unit : chosen) mixture.push_back({unit, 1});
    const auto acting = combiner.ActingUnits(StateOf(mixture));
    const bool whole = std::ranges::all_of(
        mixture, [&](const Label& label) { return acting.left[std::stoul(label.unit)] > 0.999F; });
    if (apart && !whole) continue;
    if (seen.insert(chosen).second) out.push_back(std::move(mixture));
  }
  return out;
}

}  // namespace facespace

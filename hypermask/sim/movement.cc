#include "hypermask/sim/movement.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace hypermask {
namespace {

constexpr std::pair<const char*, Movement::Kind> kKinds[] = {
    {"still", Movement::Kind::kStill}, {"places", Movement::Kind::kPlaces},
    {"sway", Movement::Kind::kSway},   {"walk", Movement::Kind::kWalk},
    {"shake", Movement::Kind::kShake}, {"turn", Movement::Kind::kTurn}};

constexpr double kDistance = 2000;  // of the mask from the projector, mm
constexpr double kNeck = 110;       // of the axis a head turns about behind the mask, mm

double Radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// Degrees; a head turned about its neck, with the mask before it.
Pose Head(const Eigen::Vector3d& place, double yaw, double pitch, double roll) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const Eigen::Matrix3d turn =
      (AngleAxisd(Radians(yaw), Vector3d::UnitY()) * AngleAxisd(Radians(pitch), Vector3d::UnitX()) *
       AngleAxisd(Radians(roll), Vector3d::UnitZ()))
          .toRotationMatrix();
  const Vector3d neck(0, 0, kNeck);
  return {turn, place + neck - turn * neck};
}

/// From 0 to 1 with the least jerk (Flash and Hogan 1985).
double MinimumJerk(double part) {
  const double t = std::clamp(part, 0.0, 1.0);
  return t * t * t * (10 - 15 * t + 6 * t * t);
}

}  // namespace

std::optional<Movement::Kind> Movement::Named(std::string_view name) {
  for (const auto& [word, kind] : kKinds) {
    if (name == word) return kind;
  }
  return std::nullopt;
}

const char* Movement::NameOf(Kind kind) {
  for (const auto& [word, of] : kKinds) {
    if (of == kind) return word;
  }
  return "";
}

std::string Movement::Names() {
  std::string names;
  for (const auto& [word, kind] : kKinds) names += (names.empty() ? "" : ", ") + std::string(word);
  return names;
}

/// The same number for the same `what` and seed.
double Movement::Chance(std::uint32_t what, double from, double to) const {
  std::uint32_t x = what * 0x9E3779B9u ^ (seed_ + 0x7F4A7C15u) * 0x85EBCA6Bu;
  x ^= x >> 16;  // the mixing of MurmurHash3's 32-bit finalizer
  x *= 0x85EBCA6Bu;
  x ^= x >> 13;
  x *= 0xC2B2AE35u;
  x ^= x >> 16;
  return from + (to - from) * static_cast<double>(x >> 8) / (1 << 24);
}

/// One that in every `slot` of seconds goes to another value made by chance, within about `moving`
/// seconds, and then rests.
double Movement::Towards(std::uint32_t what, double seconds, double slot, double moving,
                         double least, double most) const {
  const auto number = static_cast<std::uint32_t>(std::max(0.0, std::floor(seconds / slot)));
  const auto goal = [&](std::uint32_t n) {
    return n == 0 ? 0.5 * (least + most) : Chance(what + 97 * n, least, most);
  };
  const double takes = moving * Chance(what + 97 * number + 50, 0.8, 1.25);
  const double part = (seconds - number * slot) / takes;
  return goal(number) + (goal(number + 1) - goal(number)) * MinimumJerk(part);
}

Pose Movement::At(double t) const {
  const Eigen::Vector3d middle(0, 0, kDistance);
  const auto wave = [&](std::uint32_t what, double least_hertz, double most_hertz) {
    return std::sin(2 * std::numbers::pi *
                    (Chance(what, least_hertz, most_hertz) * t + Chance(what + 1, 0, 1)));
  };
  switch (kind_) {
    case Kind::kStill:
      return {Eigen::Matrix3d::Identity(), middle};
    case Kind::kPlaces: {
      struct At {
        double x, y, z, yaw, pitch, roll;
      };
      constexpr At kPlaces[] = {{0, 0, 2000, 0, 0, 0},        {-420, -60, 1750, 22, 8, 0},
                                {420, 50, 2250, -24, -10, 5}, {300, -90, 1650, 15, -14, -4},
                                {-330, 80, 2350, -18, 12, 3}, {0, -40, 2600, 20, 10, 0}};
      const auto number = static_cast<std::size_t>(std::max(0.0, t) / kHoldSeconds);
      const At& at = kPlaces[number % std::size(kPlaces)];
      return Head(Eigen::Vector3d(at.x, at.y, at.z), at.yaw, at.pitch, at.roll);
    }
    case Kind::kSway: {
      const double side = 110 * wave(10, 0.35, 0.5) + 35 * wave(20, 0.65, 0.9);
      return Head(middle + Eigen::Vector3d(side, 12 * wave(30, 0.7, 1), 40 * wave(40, 0.2, 0.4)),
                  9 * wave(50, 0.3, 0.6), 4 * wave(60, 0.3, 0.6), side / 18);
    }
    case Kind::kWalk: {
      const double x = Towards(100, t, 2.6, 1.9, -430, 430);
      const double z = Towards(200, t, 2.6, 1.9, -300, 350);
      // Steps are taken while it goes.
      const double speed = std::abs(Towards(100, t + 0.05, 2.6, 1.9, -430, 430) - x) / 0.05;
      const double going = std::min(1.0, speed / 250);
      const double phase = 2 * std::numbers::pi * t;
      return Head(middle + Eigen::Vector3d(x + 14 * going * std::sin(phase),
                                           18 * going * std::cos(2 * phase), z),
                  Towards(300, t, 2.6, 1.2, -15, 15), 2 * going * std::sin(2 * phase),
                  2.5 * going * std::sin(phase));
    }
    case Kind::kShake: {
      constexpr double kSlot = 2.6;
      const auto number = static_cast<std::uint32_t>(std::max(0.0, std::floor(t / kSlot)));
      const double within = std::max(0.0, t - number * kSlot);
      const double hertz = Chance(400 + 31 * number, 1.4, 2.4);
      const double swings = std::floor(Chance(500 + 31 * number, 2, 4));
      const double part = within * hertz / swings;
      const double strength =
          part < 1 ? std::pow(std::max(0.0, std::sin(std::numbers::pi * part)), 0.6) : 0;
      const double yaw = Chance(600 + 31 * number, 9, 16) * strength *
                         std::sin(2 * std::numbers::pi * hertz * within);
      return Head(middle + Eigen::Vector3d(8 * wave(30, 0.2, 0.4), 5 * wave(40, 0.2, 0.4), 0), yaw,
                  2 * wave(60, 0.2, 0.5), 1.5 * wave(70, 0.2, 0.5));
    }
    case Kind::kTurn:
      return Head(middle + Eigen::Vector3d(12 * wave(30, 0.2, 0.4), 8 * wave(40, 0.2, 0.4), 0),
                  Towards(700, t, 1.7, 0.75, -30, 30), Towards(800, t, 1.7, 0.75, -20, 20),
                  Towards(900, t, 1.7, 0.75, -8, 8));
  }
  return {};
}

}  // namespace hypermask

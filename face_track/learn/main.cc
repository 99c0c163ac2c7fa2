// Makes tables/seen_face.txt: draws our heads as they turn and with each unit, and lets the network
// look at them.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "face_fit/find/network/attention_points.h"
#include "face_fit/find/network/face_networks.h"
#include "face_fit/fit/least_squares.h"
#include "face_track/learn/judge.h"
#include "face_track/learn/mouth_lesson.h"
#include "face_track/learn/sitter.h"
#include "face_track/learn/variations.h"
#include "fsm/faces/face_of_name.h"
#include "vm_protocol/core/or_throw.h"

namespace {

using namespace facetrack;

/// Channels without their motions. Units whose two sides go together in people, and which the
/// network hardly sees of one alone, are of both.
std::vector<Channel> Channels() {
  std::vector<Channel> channels;
  const std::vector<float> usual{0.33F, 0.67F, 1};
  const auto add = [&](Channel::Kind kind, int unit, const char* side, std::vector<float> doses) {
    Channel channel;
    channel.kind = kind;
    channel.unit = unit;
    channel.side = side;
    channel.doses = std::move(doses);
    channels.push_back(std::move(channel));
  };
  for (const int unit : {1, 2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 20, 43}) {
    for (const char* side : {"L", "R"}) add(Channel::Kind::kUnit, unit, side, usual);
  }
  for (const int unit : {16, 17, 18, 22, 23, 24, 25, 28})
    add(Channel::Kind::kUnit, unit, "", usual);
  add(Channel::Kind::kUnit, 26, "", {0.33F, 0.67F, 1, 1.5F, 2});
  for (const char* side : {"L", "R"}) {
    add(Channel::Kind::kGazeDown, 0, side, {-20, -10, 10, 20});
    add(Channel::Kind::kGazeRight, 0, side, {-30, -15, 15, 30});
  }
  return channels;
}

constexpr float kDown[] = {-28, -20, -12, -5, 5, 12, 20, 28, 0};
constexpr float kRight[] = {-45, -36, -28, -20, -12, -5, 5, 12, 20, 28, 36, 45, 0};

struct Look {
  float down, right;
  std::vector<glm::vec2> slides;
};

/// Sums over all heads.
struct Sums {
  SeenFace face;
  std::vector<Look> looks;
  Variations variations;
  int heads = 0;

  void Add(Sitter& sitter) {
    ++heads;
    face.rest.resize(kPoints, glm::vec3(0));
    face.depth.resize(kPoints, 0);
    for (std::size_t i = 0; i < kPoints; ++i) {
      face.rest[i] += sitter.rest()[i];
      if (i < kIris) face.depth[i] += sitter.depth()[i];
    }
    for (const float down : kDown) {
      for (const float right : kRight) {
        if (std::abs(down) > 15 && std::abs(right) > 30) continue;
        looks.push_back({down, right, sitter.Slides(down, right)});
      }
    }
    Variations::Seen seen;
    for (Channel& channel : face.channels) {
      seen.emplace_back();
      channel.motion.resize(channel.doses.size(), Points(kPoints, glm::vec3(0)));
      for (std::size_t k = 0; k < channel.doses.size(); ++k) {
        const Sitter::Motion motion = sitter.MotionOf(channel, channel.doses[k]);
        for (std::size_t i = 0; i < kPoints; ++i) channel.motion[k][i] += motion.moved[i];
        seen.back().push_back(motion.seen);
      }
    }
    variations.Add(std::move(seen));
  }

  SeenFace Mean() const {
    SeenFace mean = face;
    const float part = 1 / static_cast<float>(heads);
    for (glm::vec3& p : mean.rest) p *= part;
    for (float& z : mean.depth) z *= part;
    for (Channel& channel : mean.channels) {
      for (Points& points : channel.motion) {
        for (glm::vec3& p : points) p *= part;
      }
    }
    return mean;
  }

  /// The factors of the slides, and what they leave.
  void FitSlides(SeenFace& to) const {
    to.slide.resize(kPoints);
    to.spread.assign(kPoints, 0);
    for (std::size_t i = 0; i < kPoints; ++i) {
      for (int axis = 0; axis < 2; ++axis) {
        facefit::LinearLeastSquares equations;
        for (const Look& look : looks) {
          const auto t = SeenFace::SlideTerms(look.down, look.right);
          equations.Add({t[0], t[1], t[2], t[3], t[4], t[5], t[6], t[7], t[8]},
                        look.slides[i][axis]);
        }
        const auto solved = equations.Solve(0.1);
        for (std::size_t k = 0; k < SeenFace::kSlides; ++k) {
          to.slide[i][k][axis] = static_cast<float>(solved[k]);
        }
      }
      float sum = 0;
      for (const Look& look : looks) {
        const glm::vec2 left = look.slides[i] - to.Slide(i, look.down, look.right);
        sum += glm::dot(left, left);
      }
      to.spread[i] = std::sqrt(sum / static_cast<float>(looks.size()));
    }
  }
};

/// What is seen of one side is averaged with the other's mirrored.
SeenFace Balanced(const SeenFace& face, const Mirroring& mirroring) {
  constexpr glm::vec3 kFlip(-1, 1, 1);
  SeenFace balanced = face;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const std::size_t m = mirroring.points[i];
    if (!mirroring.IsPaired(face, i)) continue;
    balanced.rest[i] = 0.5F * (face.rest[i] + kFlip * face.rest[m]);
    balanced.depth[i] = 0.5F * (face.depth[i] + face.depth[m]);
    balanced.spread[i] = 0.5F * (face.spread[i] + face.spread[m]);
    for (std::size_t k = 0; k < SeenFace::kSlides; ++k) {
      // Terms with odd powers of y change their sign.
      const bool odd = k == 0 || k == 3 || k == 5 || k == 7;
      const glm::vec2 flip = odd ? glm::vec2(1, -1) : glm::vec2(-1, 1);
      balanced.slide[i][k] = 0.5F * (face.slide[i][k] + flip * face.slide[m][k]);
    }
    for (std::size_t c = 0; c < face.channels.size(); ++c) {
      const Channel& own = face.channels[c];
      const Channel& opposite = face.channels[mirroring.channels[c]];
      for (std::size_t k = 0; k < own.doses.size(); ++k) {
        const std::size_t j = Mirroring::Dose(own, k);
        balanced.channels[c].motion[k][i] =
            0.5F * (own.motion[k][i] + kFlip * opposite.motion[j][m]);
      }
    }
  }
  return balanced;
}

void WriteTable(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write '" + path + "'");
}

void Learn(const std::string& out, std::size_t heads, const std::string& folder) {
  facefit::FaceNetworks networks = vm::OrThrow(facefit::FaceNetworks::Load(folder));
  facefit::AttentionNetwork attention = vm::OrThrow(facefit::AttentionNetwork::Load(folder));
  HeadPainter painter;
  Sums sums;
  sums.face.channels = Channels();
  for (std::size_t number = 0; static_cast<std::size_t>(sums.heads) < heads; ++number) {
    std::cerr << fmt::format("face_track_learn: head {} of {}\n", sums.heads + 1, heads);
    Sitter sitter(SomeHead(number), networks, attention, painter);
    Sums with = sums;
    try {
      with.Add(sitter);
    } catch (const std::runtime_error& lost) {
      if (number < 2 || number > 2 * heads) throw;
      std::cerr << fmt::format("face_track_learn: number {} is left out: {}\n", number,
                               lost.what());
      continue;
    }
    sums = std::move(with);
  }
  SeenFace face = sums.Mean();
  sums.FitSlides(face);
  const Mirroring mirroring = Mirroring::Of(face);
  face = Balanced(face, mirroring);
  sums.variations.Teach(mirroring, face);
  WriteTable(out, face.Print());
}

/// A face by its name, or by a number that made by chance.
std::unique_ptr<fsm::Head> JudgedHead(const std::string& name) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  const bool made = error == std::errc() && end == name.data() + name.size();
  return made ? SomeHead(number) : fsm::MakeHeadOfName(name);
}

void JudgeFaces(const std::vector<std::string>& names, bool shown, const std::string& folder) {
  facefit::FaceNetworks networks = vm::OrThrow(facefit::FaceNetworks::Load(folder));
  facefit::AttentionNetwork attention = vm::OrThrow(facefit::AttentionNetwork::Load(folder));
  HeadPainter painter;
  std::vector<JudgedDose> judged;
  for (const std::string& name : names) {
    fmt::print("{}\n", name);
    Sitter sitter(JudgedHead(name), networks, attention, painter);
    const auto doses = Judge(SeenFace::Shipped(), sitter, shown);
    judged.insert(judged.end(), doses.begin(), doses.end());
  }
  fmt::print("{}", TableOfUnits(judged));
}

}  // namespace

int main(int argc, char** argv) {
  std::string out, networks;
  std::vector<std::string> judged;
  std::size_t heads = 8;
  bool mouth = false, shown = false;
  CLI::App app(
      "Draws our heads and writes what the landmark network sees of them (docs/tracking.md)");
  auto* table = app.add_option("out", out, "The table to write: face_track/tables/seen_face.txt");
  app.add_option("--heads", heads, "How many heads; from the third on they are made by chance")
      ->check(CLI::Range(1, 100));
  auto* const judge = app.add_option("--judge", judged,
                                     "Learns nothing, and prints how turns and units of these "
                                     "faces are found; a number is a "
                                     "face made by chance")
                          ->excludes(table);
  app.add_flag("--shown", shown, "The judged faces show each unit first, as --learn-units has it")
      ->needs(judge);
  app.add_flag("--mouth", mouth,
               "The table is face_track/tables/mouth_of_lips.txt, by what seen_face.txt is now")
      ->needs(table);
  app.add_option("--networks", networks, "Where scripts/face_networks.sh put the networks");
  CLI11_PARSE(app, argc, argv);
  try {
    if (!judged.empty())
      JudgeFaces(judged, shown, networks);
    else if (mouth)
      WriteTable(out, LearnMouth(heads, networks).Print());
    else
      Learn(out, heads, networks);
  } catch (const std::exception& error) {
    std::cerr << "face_track_learn: " << error.what() << std::endl;
    return 1;
  }
}

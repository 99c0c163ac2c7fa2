// A photo whose truth is known: another built-in head, drawn. What is fitted to the image is
// compared with the head it was drawn from.

#include <gtest/gtest.h>

#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "face_fit/find/network/face_finder.h"
#include "face_fit/fit/fit.h"
#include "face_fit/fit/pixel_warp.h"
#include "face_fit/side/profile_depth.h"
#include "face_fit/side/profile_search.h"
#include "face_fit/side/side_pose.h"
#include "face_fit/side/stereo_depth.h"
#include "fsm/head/make_head.h"
#include "fsm/head/photo_head.h"
#include "fsm/mesh/head_points.h"
#include "fsm/render/renderer.h"
#include "tests/face_fit/network_fixture.h"

namespace facefit {
namespace {

constexpr int kTruthSide = 900;
constexpr const char* kPlaces[] = {"exocanthion_right", "exocanthion_left", "endocanthion_right",
                                   "endocanthion_left", "cheilion_right",   "cheilion_left",
                                   "pronasale",         "subnasale",        "alare_right",
                                   "alare_left",        "nasion",           "gnathion"};

/// The head drawn, turned by so many degrees; `warp`: into another form.
fsm::Image PhotoOf(const fsm::Head& head, float turn, const fsm::Warp* warp = nullptr) {
  fsm::FaceState state;
  state.figure.rotation = {0, turn, 0};
  fsm::HeadVertices vertices;
  head.Evaluate(state, vertices);
  for (glm::vec3& p : vertices.position) {
    if (warp) p += warp->Motion(p);
  }
  const auto context = fsm::RenderContext::MakeHeadless(kTruthSide, kTruthSide);
  const auto renderer = fsm::Renderer::Make(*context);
  renderer->DrawVertices(head, vertices, state.figure, fsm::Scene{});
  fsm::Image photo;
  renderer->Read(photo);
  return photo;
}

std::unique_ptr<fsm::Head> HeadOf(const FaceFit& fit) {
  fsm::PhotoHead set;
  set.points = fit.head.warp_points;
  set.smooth = kWarpSmoothMm;
  set.eyes = fit.head.eyes;
  set.atlas = std::make_shared<fsm::Image>(fsm::Image{1, 1, {0, 0, 0, 255}});
  return fsm::MakeHead(set);
}

/// A head whose profile is not the built-in one's: brow and chin lie back, the nose stands forward,
/// or (`strength` negative) the other way round. Seen from the front it hardly differs.
class Profile {
 public:
  Profile(const fsm::Head& head, float strength) : head_(head) {
    const std::pair<const char*, float> moves[] = {
        {"pronasale", 6},         {"nasion", -3},       {"gnathion", -6},
        {"trichion", -7},         {"subnasale", 2},     {"exocanthion_left", 0},
        {"exocanthion_right", 0}, {"tragion_left", 0},  {"tragion_right", 0},
        {"zygion_left", -1},      {"zygion_right", -1}, {"cheilion_left", -2},
        {"cheilion_right", -2},   {"alare_left", 1},    {"alare_right", 1},
        {"gonion_left", 0},       {"gonion_right", 0}};
    std::vector<fsm::WarpPoint> points;
    for (const auto& [place, z] : moves) {
      points.push_back({head.Landmark(place), glm::vec3(0, 0, strength * z)});
    }
    warp_ = fsm::Warp(points, 0);
  }
  glm::vec3 Landmark(const char* place) const {
    const glm::vec3 p = head_.Landmark(place);
    return p + warp_.Motion(p);
  }
  fsm::Image Photo(float turn) const { return PhotoOf(head_, turn, &warp_); }

 private:
  const fsm::Head& head_;
  fsm::Warp warp_;
};

/// The head that is drawn, and what is found in photos of it and fitted to them. All of that is
/// shared by the tests of the suite, which look at it in several ways.
class TruthTest : public NetworkTest, public testing::WithParamInterface<const char*> {
 protected:
  /// A photo from the front.
  struct Front {
    fsm::Image photo;
    std::size_t faces;
    FoundFace face;
    FaceFit fit;
  };

  static void TearDownTestSuite() {
    fronts_.clear();
    truths_.clear();
    NetworkTest::TearDownTestSuite();
  }
  static const fsm::Head& truth() {
    auto& head = truths_[GetParam()];
    if (!head) head = fsm::MakeSymmetricHead(GetParam());
    return *head;
  }
  static const Front& front() {
    return FrontOf(0, [] { return PhotoOf(truth(), 0); });
  }
  static SidePhoto SideOf(const fsm::Image& photo) {
    const auto faces = FindFaces(*networks_, photo);
    return {"", photo, faces.empty() ? std::nullopt : std::optional(faces.front())};
  }
  static const Front& FrontOf(const Profile& truth, float strength) {
    return FrontOf(strength, [&truth] { return truth.Photo(0); });
  }

 private:
  template <typename F>
  static const Front& FrontOf(float strength, F photo_of) {
    auto& front = fronts_[{GetParam(), strength}];
    if (front) return *front;
    fsm::Image photo = photo_of();
    const auto faces = FindFaces(*networks_, photo);
    const FoundFace& face = faces.at(0);
    FaceFit fit = FitFace(Galatea(), face, photo);
    return front.emplace(Front{std::move(photo), faces.size(), face, std::move(fit)});
  }

  static inline std::map<std::string, std::unique_ptr<fsm::Head>> truths_;
  static inline std::map<std::pair<std::string, float>, std::optional<Front>> fronts_;
};

/// Places of both heads, the fitted one brought over the true one.
std::vector<fsm::PointPair> Compared(const fsm::Head& truth, const fsm::Head& fitted) {
  std::vector<fsm::PointPair> pairs;
  for (const char* place : kPlaces) {
    pairs.push_back({truth.Landmark(place), fitted.Landmark(place), fsm::FaceFeature::kNone});
  }
  const fsm::Similarity over = fsm::FitSimilarity(pairs);
  for (auto& pair : pairs) pair.to = over(pair.to);
  return pairs;
}

TEST_P(TruthTest, LandmarksAndDepthComeNearTheHeadThatWasDrawn) {
  ASSERT_EQ(front().faces, 1U);
  const auto fitted = HeadOf(front().fit);
  const auto pairs = Compared(truth(), *fitted);
  const float eyes = glm::distance(pairs[0].from, pairs[1].from);
  float sum = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const float flat = glm::distance(glm::vec2(pairs[i].from), glm::vec2(pairs[i].to));
    sum += flat / eyes;
    std::printf("%-9s %-20s %4.1f %% of the eyes' distance, depth %+.1f mm\n", GetParam(),
                kPlaces[i], static_cast<double>(100 * flat / eyes),
                static_cast<double>(pairs[i].to.z - pairs[i].from.z));
  }
  std::printf("%-9s mean %.2f %%\n", GetParam(),
              static_cast<double>(100 * sum / static_cast<float>(pairs.size())));
  EXPECT_LT(sum / static_cast<float>(pairs.size()), 0.016F);
  for (const std::size_t i : {6U, 10U, 11U}) {  // nose, between the brows, chin
    EXPECT_LT(std::abs(pairs[i].to.z - pairs[i].from.z), 4) << kPlaces[i];
  }
}

TEST_P(TruthTest, LipsBesideTheCornersLieWhereThePhotoShowsThemWhereverTheNetworkSeesThem) {
  const ObservedHead& base = Galatea();
  const auto corners = [&](const FaceFit& fit) {
    return std::pair(fit.head.PositionOf(61).y, fit.head.PositionOf(291).y);
  };
  const auto said = corners(front().fit);
  const float pixels_per_mm = glm::distance(front().face.points[33], front().face.points[263]) / 90;
  for (const float higher_mm : {-2.5F, 2.5F}) {
    FoundFace face = front().face;
    for (const std::size_t i : {61U, 291U, 185U, 409U, 146U, 375U, 78U, 308U}) {
      face.points[i].y -= higher_mm * pixels_per_mm;
    }
    const auto moved = corners(FitFace(base, face, front().photo));
    EXPECT_NEAR(moved.first, said.first, 0.6F) << higher_mm;
    EXPECT_NEAR(moved.second, said.second, 0.6F) << higher_mm;
  }
}

/// Root of the mean square of the depths' errors, millimetres.
float DepthError(const Profile& truth, const FaceFit& fit) {
  std::vector<fsm::PointPair> pairs;
  const auto fitted = HeadOf(fit);
  for (const char* place : kPlaces) {
    pairs.push_back({truth.Landmark(place), fitted->Landmark(place), fsm::FaceFeature::kNone});
  }
  const fsm::Similarity over = fsm::FitSimilarity(pairs);
  float sum = 0;
  for (const auto& pair : pairs) {
    const float off = over(pair.to).z - pair.from.z;
    sum += off * off / static_cast<float>(pairs.size());
  }
  return std::sqrt(sum);
}

TEST_P(TruthTest, ASecondPhotoFromTheSideBringsDepthNearer) {
  float all_without = 0, all_with = 0, count = 0;
  for (const float strength : {1.0F, -1.0F}) {
    const Profile truth(this->truth(), strength);
    const auto& [photo, faces, face, front] = FrontOf(truth, strength);
    const float without = DepthError(truth, front);
    for (const float turn : {-40.0F, 25.0F, 40.0F, 55.0F}) {
      const fsm::Image side = truth.Photo(turn);
      const auto pose = FitSidePose(*networks_, front.head, SideOf(side));
      ASSERT_TRUE(pose) << turn << ": " << pose.error().reason;
      const auto [corrected, refined] = CorrectDepthByStereo(photo, side, *pose, front);
      const float with = DepthError(truth, corrected);
      std::printf("%-9s %+.0f turned %+.0f (found %+.0f): depth %.2f mm off, front alone %.2f\n",
                  GetParam(), static_cast<double>(strength), static_cast<double>(turn),
                  static_cast<double>(glm::degrees(refined.rotation_rad.y)),
                  static_cast<double>(with), static_cast<double>(without));
      all_without += without;
      all_with += with;
      count += 1;
    }
  }
  std::printf("%-9s mean depth error %.2f mm, front alone %.2f\n", GetParam(),
              static_cast<double>(all_with / count), static_cast<double>(all_without / count));
  // Smooth drawn skin has little to recognise; single views may even mislead.
  EXPECT_LT(all_with, 0.93F * all_without);
}

/// 1 where an image drawn on an even background shows something.
FloatImage FigureOf(const fsm::Image& photo) {
  FloatImage figure(photo.width, photo.height);
  for (std::size_t i = 0; i < figure.values.size(); ++i) {
    int off = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      off = std::max(off, std::abs(photo.rgba[4 * i + c] - photo.rgba[c]));
    }
    figure.values[i] = off > 12 ? 1.0F : 0.0F;
  }
  return figure;
}

// Size and lean of the person in the second image are found with the outline, so that one shape
// may gain little; over two shapes it is much.
TEST_P(TruthTest, TheOutlineOfAProfileBringsDepthNearer) {
  float all_with = 0, all_without = 0;
  for (const float strength : {1.0F, -1.0F}) {
    const Profile truth(this->truth(), strength);
    const auto& [photo, faces, face, front] = FrontOf(truth, strength);
    const float without = DepthError(truth, front);
    for (const float turn : {-90.0F, 90.0F}) {
      const Mask figure = FigureOf(truth.Photo(turn));
      const auto corrected = CorrectDepthByProfile(figure, front);
      ASSERT_TRUE(corrected) << turn;
      EXPECT_EQ(FindProfile(front.head, figure)->towards == PhotoEdge::kRight, turn > 0);
      // The profile is searched where the network's points cannot be compared, not where they show
      // another person. Of one of these heads they can be.
      const auto turned = FitSidePose(*networks_, front.head, SideOf(truth.Photo(turn)));
      if (!turned) {
        EXPECT_TRUE(turned.error().may_be_profile) << turned.error().reason;
      }
      const float with = DepthError(truth, *corrected);
      std::printf("%-9s %+.0f profile %+.0f: depth %.2f mm off, front alone %.2f\n", GetParam(),
                  static_cast<double>(strength), static_cast<double>(turn),
                  static_cast<double>(with), static_cast<double>(without));
      EXPECT_LT(with, 1.2F * without);
      all_with += with;
      all_without += without;
    }
  }
  EXPECT_LT(all_with, 0.96F * all_without);
}

TEST_P(TruthTest, AnOutlineThatIsNoProfileCorrectsNothing) {
  FloatImage box(300, 400), round(300, 400);
  for (int y = 50; y < 350; ++y) {
    for (int x = 50; x < 250; ++x) {
      box(x, y) = 1;
      if (std::hypot(x - 150, (y - 200) * 0.7) < 95) round(x, y) = 1;
    }
  }
  for (const FloatImage& figure :
       {box, round, FloatImage(300, 400), FloatImage(300, 400, 1), FloatImage(1, 1, 1)}) {
    EXPECT_FALSE(CorrectDepthByProfile(figure, front().fit));
  }
}

TEST_P(TruthTest, APhotoThatDoesNotHelpIsRefusedInWords) {
  const auto refusal = [&](const fsm::Image& photo) {
    const auto view = FitSidePose(*networks_, front().fit.head, SideOf(photo));
    return view ? "it is taken" : view.error().reason;
  };
  const fsm::Image grey{
      .width = 300, .height = 300, .rgba = std::vector<std::uint8_t>(300 * 300 * 4, 128)};
  EXPECT_NE(refusal(grey).find("no face"), std::string::npos);
  EXPECT_NE(refusal(front().photo).find("from the front"), std::string::npos)
      << refusal(front().photo);
  // A face as wide as two is another person's, also from the front.
  for (const float turn : {0.0F, 40.0F}) {
    const fsm::Image photo = PhotoOf(truth(), turn);
    fsm::Image wide{.width = 2 * photo.width, .height = photo.height, .rgba = {}};
    for (std::size_t i = 0; i < photo.rgba.size(); i += 4) {
      for (int k = 0; k < 2; ++k) {
        wide.rgba.insert(wide.rgba.end(), photo.rgba.begin() + static_cast<std::ptrdiff_t>(i),
                         photo.rgba.begin() + static_cast<std::ptrdiff_t>(i + 4));
      }
    }
    // Turned as well, it may be no face at all to the network.
    const std::string why = refusal(wide);
    EXPECT_TRUE(why.contains("does not fit the front photo's") ||
                (turn > 0 && why.contains("no eyes, nose and mouth can be told apart")))
        << turn << ": " << why;
  }
}

INSTANTIATE_TEST_SUITE_P(OtherFaces, TruthTest, testing::Values("pygmalion", "baucis"));

}  // namespace
}  // namespace facefit

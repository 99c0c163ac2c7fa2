// Heads made by others, whose own shapes are the truth: ../shared/data/heads is not part of the
// repository (docs/heads.md), and neither are the networks; without them the tests are skipped.

#include "face_fit/find/head/head_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>

#include "fsm/head/make_head.h"
#include "fsm/mesh/align_imported_head.h"
#include "fsm/mesh/obj/obj_file.h"
#include "fsm/mesh/rig_unrigged_head.h"
#include "fsm/mesh/rigging/transferred_rig.h"
#include "tests/face_fit/network_fixture.h"
#include "tests/support/test_data.h"

namespace facefit {
namespace {

/// A head by its points in our frame, with its own shapes as offsets of its vertices.
struct Subject {
  fsm::UnriggedHead model;
  std::vector<std::uint32_t> flesh, eyes;
  std::vector<fsm::PointPair> pairs;  // from: galatea
  std::map<std::string, std::vector<glm::vec3>> shapes;
};

class HeadFinderTest : public NetworkTest {
 protected:
  void SetUp() override {
    if (const auto heads = support::Heads(); !heads.Has()) GTEST_SKIP() << heads.Missing();
    NetworkTest::SetUp();
  }
  static void TearDownTestSuite() {
    subjects_.clear();
    NetworkTest::TearDownTestSuite();
  }

  /// Read and looked at once.
  static const Subject& Of(const std::string& name) {
    auto& subject = subjects_[name];
    if (!subject) subject.emplace(Read(name));
    return *subject;
  }

 private:
  static Subject Read(const std::string& name) {
    const std::string folder = support::Heads() / name;
    const auto file = fsm::ReadImportedHead(folder + "/neutral.obj");
    EXPECT_TRUE(file) << file.error().text;
    const auto points = vm::OrThrow(FindHeadPoints(*networks_, *file, name, "galatea"));
    const auto place = fsm::FitSimilarity(points.pairs);
    Subject subject;
    subject.pairs = points.pairs;
    for (auto& pair : subject.pairs) pair.to = place(pair.to);
    subject.model = fsm::AlignImportedHead(*file, place, -43);
    subject.flesh = subject.model.FleshTriangles();
    subject.eyes = subject.model.EyeTriangles();
    // The shapes number the file's own lines; the reader keeps what its faces use, by place.
    const auto obj = fsm::ReadObj(folder + "/neutral.obj");
    std::map<std::tuple<float, float, float>, std::vector<std::uint32_t>> at;
    for (std::uint32_t i = 0; i < file->position.size(); ++i) {
      const glm::vec3 p = file->position[i];
      at[{p.x, p.y, p.z}].push_back(i);
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder + "/delta")) {
      std::vector<glm::vec3> by(subject.model.mesh.position.size(), glm::vec3(0));
      std::ifstream lines(entry.path());
      for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::size_t index = 0;
        glm::vec3 d;
        if (!(words >> index >> d.x >> d.y >> d.z) || index >= obj->positions.size()) continue;
        const glm::vec3 p = obj->positions[index];
        for (const std::uint32_t v : at[{p.x, p.y, p.z}])
          by[v] = place.scale * (place.rotation * d);
      }
      subject.shapes[entry.path().stem().string()] = std::move(by);
    }
    return subject;
  }

  static inline std::map<std::string, std::optional<Subject>> subjects_;
};

/// Mean distance of `carried` from `truth` over the flesh that really moves, as part of its motion.
float ErrorOf(const Subject& subject, const std::vector<glm::vec3>& truth,
              const std::vector<glm::vec3>& carried) {
  float most = 0, error = 0, motion = 0;
  std::vector<bool> skin(truth.size(), false);
  for (const auto& batch : subject.model.mesh.batches) {
    if (batch.material != fsm::Material::kSkin) continue;
    for (const std::uint32_t v : batch.indices) skin[v] = true;
  }
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (skin[i]) most = std::max(most, glm::length(truth[i]));
  }
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!skin[i] || glm::length(truth[i]) < 0.1F * most) continue;
    error += glm::distance(truth[i], carried[i]);
    motion += glm::length(truth[i]);
  }
  EXPECT_GT(motion, 0);
  return error / std::max(motion, 1e-6F);
}

TEST_F(HeadFinderTest, ShapesOfAnotherMakerComeBackFromOurHeadNearlyAsTheyWent) {
  for (const char* name : {"ict", "makehuman"}) {
    const Subject& subject = Of(name);
    const auto ours = fsm::MakeSymmetricHead("galatea");
    fsm::HeadVertices rest;
    ours->Evaluate({}, rest);
    const auto flesh = fsm::SkinTriangles(ours->surface());
    std::vector<fsm::PointPair> back = subject.pairs;
    for (auto& pair : back) std::swap(pair.from, pair.to);
    // As the program does it (fsm/mesh/transfer/transferred_rig.cc).
    const auto eyes = fsm::EyeballTriangles(ours->surface());
    const fsm::TransferSurface own{rest.position, flesh, false, eyes};
    const fsm::TransferSurface theirs{subject.model.mesh.position, subject.flesh,
                                      subject.model.has_uv_seams, subject.eyes};
    const fsm::DeformationTransfer there(theirs, own, back), home(own, theirs, subject.pairs);
    float sum = 0, worst = 0;
    int within = 0;
    for (const auto& [shape, truth] : subject.shapes) {
      std::vector<glm::vec3> on_ours(rest.position.size(), glm::vec3(0)),
          again(truth.size(), glm::vec3(0));
      there.Apply(truth, on_ours);
      home.Apply(on_ours, again);
      const float error = ErrorOf(subject, truth, again);
      std::printf("%-10s %-28s %5.1f %%\n", name, shape.c_str(), static_cast<double>(100 * error));
      sum += error;
      worst = std::max(worst, error);
      within += error < 0.15F ? 1 : 0;
    }
    const auto count = static_cast<float>(subject.shapes.size());
    std::printf("%-10s mean %.1f %%, worst %.1f %%, %d of %zu within 15 %%\n", name,
                static_cast<double>(100 * sum / count), static_cast<double>(100 * worst), within,
                subject.shapes.size());
    // A round trip makes the error of both ways. Lids are the worst: ours are of another form.
    EXPECT_LT(sum / count, name == std::string("ict") ? 0.075F : 0.145F) << name;
  }
}

TEST_F(HeadFinderTest, OurJawOpensTheirsAndOurLidsShutTheirs) {
  for (const char* name : {"ict", "makehuman"}) {
    const Subject& subject = Of(name);
    const auto pairs = subject.pairs;
    const auto mean = [&](const std::vector<glm::vec3>& position, fsm::FaceFeature part) {
      float y = 0, count = 0;
      for (const auto& pair : pairs) {
        if (pair.feature != part) continue;
        std::size_t nearest = 0;
        float least = 1e9F;
        for (const std::uint32_t v : subject.flesh) {
          const float far = glm::distance(subject.model.mesh.position[v], pair.to);
          if (far < least) {
            least = far;
            nearest = v;
          }
        }
        y += position[nearest].y - subject.model.mesh.position[nearest].y;
        count += 1;
      }
      return y / count;
    };
    fsm::UnriggedHead model = subject.model;
    fsm::RigData skin = fsm::TransferRig(model, *fsm::MakeSymmetricHead("galatea"), pairs);
    const auto head = fsm::RigUnriggedHead(std::move(model), std::move(skin));
    fsm::HeadVertices moved;
    fsm::FaceState state;
    state.au.left[27] = state.au.right[27] = 1;
    head->Evaluate(state, moved);
    EXPECT_LT(mean(moved.position, fsm::FaceFeature::kLowerLip), -15) << name;
    EXPECT_GT(mean(moved.position, fsm::FaceFeature::kUpperLip), -8) << name;
    state = {};
    state.blink.left = state.blink.right = 1;
    head->Evaluate(state, moved);
    EXPECT_LT(mean(moved.position, fsm::FaceFeature::kUpperLid), -2.5F) << name;
    EXPECT_GT(mean(moved.position, fsm::FaceFeature::kLowerLid), -2) << name;
  }
}

TEST_F(HeadFinderTest, PointsAreTheSameWhicheverWayAHeadFaces) {
  // The file's x, y and z axes, as they lie where the head faces x, -x, or -y with z up.
  const glm::mat3 turns[] = {
      {0, 0, -1, 0, 1, 0, 1, 0, 0}, {0, 0, 1, 0, 1, 0, -1, 0, 0}, {1, 0, 0, 0, 0, 1, 0, -1, 0}};
  const auto straight = fsm::ReadImportedHead(support::Heads() / "ict" + "/neutral.obj");
  ASSERT_TRUE(straight) << straight.error().text;
  const auto expected = vm::OrThrow(FindHeadPoints(*networks_, *straight, "ict", "galatea")).pairs;
  const float scale = fsm::FitSimilarity(expected).scale;
  for (const glm::mat3& turn : turns) {
    fsm::ImportedHead file = *straight;
    for (glm::vec3& p : file.position) p = turn * p;
    const auto found = vm::OrThrow(FindHeadPoints(*networks_, file, "ict", "galatea")).pairs;
    EXPECT_GT(found.size(), expected.size() / 2);
    float sum = 0, count = 0;
    for (const auto& pair : found) {
      const auto same = std::ranges::min_element(
          expected, {},
          [&pair](const fsm::PointPair& other) { return glm::distance(other.from, pair.from); });
      if (glm::distance(same->from, pair.from) > 0.1F) continue;
      sum += scale * glm::distance(turn * same->to, pair.to);
      count += 1;
    }
    EXPECT_GT(count, 0.8F * static_cast<float>(expected.size())) << turn[2].x << " " << turn[2].z;
    EXPECT_LT(sum / count, 0.5F) << "mm; faces " << turn[2].x << " " << turn[2].y;
  }
}

TEST_F(HeadFinderTest, AFileThatIsNoHeadIsNotTakenForAHeadWithoutAFace) {
  fsm::ImportedHead file;
  file.name = "empty.obj";
  file.position = {{0, 0, 0}, {0, 1, 0}};
  try {
    const auto points = FindHeadPoints(*networks_, file, "empty.obj", "galatea");
    FAIL() << (points ? "points were made up" : points.error().text);
  } catch (const std::runtime_error& error) {
    EXPECT_FALSE(std::string_view(error.what()).contains("no face is seen")) << error.what();
  }
}

TEST_F(HeadFinderTest, AHeadThatIsNeverSeenFromTheFrontIsRefused) {
  auto file = fsm::ReadImportedHead(support::Heads() / "ict" + "/neutral.obj");
  ASSERT_TRUE(file) << file.error().text;
  for (glm::vec3& p : file->position) p = {p.x, p.z, -p.y};  // it faces y
  const auto points = FindHeadPoints(*networks_, *file, "lying.obj", "galatea");
  ASSERT_FALSE(points) << "points were made up";
  // Whether the network takes the crown of a head for a face decides which of the two is said.
  const std::string& said = points.error().text;
  EXPECT_TRUE(said.contains("'lying.obj' is not seen from the front") ||
              said.starts_with("no face is seen on 'lying.obj'"))
      << said;
}

}  // namespace
}  // namespace facefit

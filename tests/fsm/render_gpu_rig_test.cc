// The steps of a rig on a GPU (here Mesa's software) beside those on the processor.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <vector>

#include "fsm/head/make_head.h"
#include "fsm/render/appearance.h"
#include "fsm/render/gpu_rig.h"
#include "fsm/render/renderer.h"
#include "fsm/rig/partial_rig.h"
#include "tests/fsm/ball_head.h"
#include "tests/fsm/wearing_photo.h"

namespace fsm {
namespace {

constexpr float kLargest = 0.05F;  // millimetres

/// Everything at once, also beyond what anatomy allows.
FaceState Wild(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&random](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  };
  FaceState state;
  for (auto* side : {&state.au.left, &state.au.right}) {
    for (std::size_t unit = 1; unit < 47; ++unit) {
      if (between(0, 1) < 0.3F) (*side)[unit] = between(0, 1.2F);
    }
  }
  for (float& mouth : state.mouth) mouth = between(-4, 4);
  state.mouth[kJawY] = between(0, 25);
  state.seal = between(-1, 1.5F);
  state.tongue = between(-0.5F, 1);
  state.blink.left = between(-1, 1.2F);
  state.blink.right = between(-1, 1.2F);
  state.gaze.left = state.gaze.right = {-between(-30, 30), between(-40, 40)};
  state.head_rotation = {between(-40, 40), between(-60, 60), between(-30, 30)};
  state.head_forward_mm = between(-20, 30);
  return state;
}

class GpuRigTest : public testing::Test {
 protected:
  GpuRigTest()
      : context_(RenderContext::MakeHeadless(16, 16)),
        gl_(GlFunctions::Load(*context_)),
        programs_(gl_) {}
  void SetUp() override {
    if (!RigPrograms::Supported(gl_))
      GTEST_SKIP() << "the driver has no compute shaders (OpenGL 4.3): "
                   << gl_.GetString(GL_VERSION);
  }

  /// Waits for the GPU and reads positions and normals of a face back.
  void Read(const GpuRig& on_gpu, std::size_t face, std::size_t vertices, HeadVertices& out) {
    const auto bytes = static_cast<GLsizeiptr>(vertices * sizeof(glm::vec3));
    for (const auto& [buffer, into] :
         {std::pair(on_gpu.positions(), &out.position), {on_gpu.normals(), &out.normal}}) {
      gl_.BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
      const auto* const first = static_cast<const glm::vec3*>(gl_.MapBufferRange(
          GL_SHADER_STORAGE_BUFFER, static_cast<GLintptr>(on_gpu.OffsetBytes(face)), bytes,
          GL_MAP_READ_BIT));
      ASSERT_NE(first, nullptr);
      into->assign(first, first + vertices);
      gl_.UnmapBuffer(GL_SHADER_STORAGE_BUFFER);
    }
  }

  /// How far faces of these states, moved in one call, lie from those of the processor.
  void ExpectEqual(const Rig& rig, const std::vector<FaceState>& states) {
    GpuRig on_gpu(gl_, programs_, rig);
    const std::vector<glm::vec3> spring_offsets(rig.data().spring_rig.springs.size(),
                                                glm::vec3(1, -2, 3));
    std::vector<GpuRig::Input> faces;
    for (const FaceState& state : states) faces.push_back({&state, spring_offsets});
    on_gpu.Evaluate(rig, faces);
    for (std::size_t face = 0; face < states.size(); ++face) {
      HeadVertices here, there;
      rig.Evaluate(states[face], here, spring_offsets);
      Read(on_gpu, face, here.position.size(), there);
      float farthest = 0, steepest = 1;
      std::size_t at = 0;
      for (std::size_t i = 0; i < here.position.size(); ++i) {
        const float far = glm::distance(here.position[i], there.position[i]);
        if (!(far <= farthest)) farthest = far, at = i;
        steepest = std::min(steepest, glm::dot(here.normal[i], there.normal[i]));
      }
      EXPECT_LE(farthest, kLargest) << "vertex " << at << " of face " << face;
      EXPECT_GT(steepest, 0.99F) << "face " << face;
    }
  }

  std::unique_ptr<RenderContext> context_;
  GlFunctions gl_;
  RigPrograms programs_;
};

std::vector<FaceState> Wilds(unsigned count) {
  std::vector<FaceState> states(1);  // at rest
  for (unsigned seed = 0; seed < count; ++seed) states.push_back(Wild(seed));
  return states;
}

TEST_F(GpuRigTest, BuiltInHeadsMoveAsOnTheProcessor) {
  for (const std::string& identity : Identities()) {
    SCOPED_TRACE(identity);
    ExpectEqual(MakeHead(identity)->rig(), Wilds(6));
  }
}

TEST_F(GpuRigTest, HeadsOfOtherKindsDoToo) {
  ExpectEqual(WearingPhoto()->rig(), Wilds(6));
  ExpectEqual(BallHead().rig(), Wilds(2));
}

/// A head on which every step finds something to do.
RigData WithAllSteps() {
  RigData data = MakeHead("galatea")->rig().data();
  data.steps.clear();
  for (int step = 0; step < static_cast<int>(kRigSteps); ++step)
    data.steps.push_back(static_cast<RigStep>(step));
  data.proxy.rest = data.rest;
  data.spring_rig.springs.resize(3);
  data.spring_rig.weights.clear();
  data.normals.twin.resize(data.rest.size());
  for (std::uint32_t i = 0; i < data.rest.size(); ++i) {
    const auto wave = 0.3F * std::sin(static_cast<float>(i));
    data.proxy.to_own.emplace_back(wave, -wave, 0.5F);
    data.normals.twin[i] = i;
    if (data.rest[i].y > 60) {
      data.spring_rig.weights.push_back({i, i % 3, 0.5F});
      data.spring_rig.weights.push_back({i, (i + 1) % 3, 0.25F});
    }
    // The vertex furthest down that the jaw wholly carries.
    if (data.weights[i].jaw > 0.99F && data.rest[i].y < data.rest[data.jaw.chin].y)
      data.jaw.chin = i;
  }
  const std::vector<std::uint32_t>& soft = data.normals.soft_triangles;
  for (std::size_t k = 0; k < soft.size(); k += 60) data.normals.twin[soft[k]] = soft[0];
  data.normals.twin[soft[0]] = soft[0];
  for (const LidRig::Vertex& lid : data.lids.vertices)
    data.ball_lids.push_back({lid.vertex, lid.side, 14.0F});
  return data;
}

TEST_F(GpuRigTest, EveryStepIsThatOfTheProcessor) {
  const RigData all = WithAllSteps();
  ExpectEqual(Rig(all), Wilds(4));
  // One step fewer each time: no step is without effect, so none is compared with itself left out.
  for (std::size_t left_out = 0; left_out < all.steps.size(); ++left_out) {
    SCOPED_TRACE(DefinitionOf(all.steps[left_out]).name);
    RigData data = all;
    data.steps.erase(data.steps.begin() + static_cast<std::ptrdiff_t>(left_out));
    HeadVertices with, without;
    bool differs = false;
    const std::vector<glm::vec3> spring_offsets(3, glm::vec3(1, 2, 3));
    const Rig whole(all), less(data);
    for (const FaceState& state : Wilds(3)) {
      whole.Evaluate(state, with, spring_offsets);
      less.Evaluate(state, without, spring_offsets);
      differs = differs || with.position != without.position || with.normal != without.normal;
    }
    EXPECT_TRUE(differs);
    ExpectEqual(less, Wilds(1));
  }
}

TEST_F(GpuRigTest, ManyFacesOfAHeadAreMovedInOneCall) {
  ExpectEqual(MakeHead("galatea")->rig(), Wilds(60));
}

TEST_F(GpuRigTest, APictureOfAHeadMovedOnTheCardIsThatOfTheProcessor) {
  const auto head = MakeHead("galatea");
  const auto context = RenderContext::MakeHeadless(200, 240);
  const auto picture = [&](RigDevice rig) {
    const auto renderer = Renderer::Make(*context, 2, Appearance::BuiltIn(), rig);
    std::vector<Image> images;
    for (const FaceState& state : Wilds(4)) {
      renderer->Draw(*head, state, {}, {});
      renderer->Read(images.emplace_back());
    }
    // Vertices of the processor's after those of the GPU.
    HeadVertices rest;
    head->Evaluate({}, rest);
    renderer->DrawVertices(*head, rest, {}, {});
    renderer->Read(images.emplace_back());
    return images;
  };
  const auto gpu = picture(RigDevice::kGpu), processor = picture(RigDevice::kProcessor);
  for (std::size_t k = 0; k < gpu.size(); ++k) {
    std::size_t differ = 0;
    for (std::size_t i = 0; i < gpu[k].rgba.size(); ++i)
      differ += std::abs(gpu[k].rgba[i] - processor[k].rgba[i]) > 8 ? 1 : 0;
    EXPECT_LT(differ, gpu[k].rgba.size() / 2000) << "picture " << k;
  }
  EXPECT_EQ(gpu.back().rgba, processor.back().rgba);
  EXPECT_NE(gpu[0].rgba, gpu[1].rgba);
}

TEST_F(GpuRigTest, AFaceThatIsAskedForAgainIsTheSame) {
  const auto head = MakeHead("galatea");
  GpuRig on_gpu(gl_, programs_, head->rig());
  const FaceState wild = Wild(3), rest;
  const std::size_t vertices = head->rig().data().rest.size();
  HeadVertices first, again;
  on_gpu.Evaluate(head->rig(), std::vector<GpuRig::Input>{{&wild}});
  Read(on_gpu, 0, vertices, first);
  on_gpu.Evaluate(head->rig(), std::vector<GpuRig::Input>{{&rest}, {&rest}, {&wild}});
  Read(on_gpu, 2, vertices, again);
  EXPECT_EQ(first.position, again.position);
  EXPECT_EQ(first.normal, again.normal);
}

TEST(PartialRigTest, SomeVerticesMoveAsWithAllOthers) {
  const auto head = MakeHead("galatea");
  const auto last = static_cast<std::uint32_t>(head->rig().data().rest.size() - 1);
  const std::vector<std::uint32_t> some{40, 7, last / 2, 7, last};
  const PartialRig partial(head->rig(), some);
  for (unsigned seed = 0; seed < 20; ++seed) {
    const FaceState state = Wild(seed);
    HeadVertices whole, part;
    head->Evaluate(state, whole);
    partial.Evaluate(state, part);
    ASSERT_EQ(part.position.size(), whole.position.size());
    for (const std::uint32_t i : some) EXPECT_EQ(part.position[i], whole.position[i]) << i;
    EXPECT_EQ(part.creases, whole.creases);
    EXPECT_EQ(part.lids_shut, whole.lids_shut);
  }
}

}  // namespace
}  // namespace fsm

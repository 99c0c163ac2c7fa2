#include "face_editor/app/stage.h"

#include <algorithm>
#include <exception>
#include <glm/geometric.hpp>

#include "face_editor/core/identity_head.h"
#include "face_fit/surface/triangles.h"

namespace editor {

Stage::Stage(fsm::RenderContext& context, MadeHead given)
    : renderer_(fsm::Renderer::Make(context)), given_(std::move(given)) {}

void Stage::TakeUnits(const Editor& editor) {
  const auto remade = remaker_.Take();
  if (remade && *remade && moved_of_ == head_) moved_ = (*remade)->head;
  const auto& units = editor.state().units;
  if (moved_of_ == head_ && moved_by_ == units) return;
  const bool same_head = moved_of_ == head_;
  moved_of_ = head_;
  moved_by_ = units;
  const bool given = head_ && head_ == given_.head;
  if (given && given_.remake) {
    if (!same_head) moved_ = nullptr;
    if (!same_head && units == editor.built_in_units()) return;
    remaker_.Ask([remake = given_.remake, units] {
      return MadeHead{remake(units->table), nullptr, "", nullptr};
    });
    return;
  }
  // A head that was given may have units of its own.
  const bool own = units != editor.built_in_units() || given;
  moved_ = head_ && own ? head_->WithUnits(units->table) : nullptr;
}

vm::Result<void> Stage::TakeOpened() {
  auto opened = opener_.Take();
  if (!opened) return {};
  if (!*opened) return std::unexpected(opened->error());
  given_ = **opened;
  notice = given_.notice;
  given_last_ = true;
  return {};
}

vm::Result<void> Stage::Update(const Editor& editor, Wanted wanted) {
  const auto opened = TakeOpened();
  auto taken = Take(editor, wanted);
  TakeUnits(editor);
  return opened ? taken : opened;
}

vm::Result<void> Stage::Take(const Editor& editor, Wanted wanted) {
  const auto& work = editor.work();
  if (work != last_work_) given_last_ = false;
  last_work_ = work;
  const bool photo = work && work->base && (wanted == Wanted::kPhoto || !given_last_);
  const Source source = wanted == Wanted::kIdentity ? Source::kIdentity
                        : photo                     ? Source::kPhoto
                        : given_.head               ? Source::kGiven
                                                    : Source::kIdentity;
  const Part part = source == Source::kPhoto ? Part::kPoints : Part::kIdentity;
  const std::uint64_t version = editor.state().version[static_cast<std::size_t>(part)];
  const bool other = source != source_ || (source == Source::kPhoto && work != work_) ||
                     (source == Source::kGiven && head_ != given_.head);
  if (other || (version != version_ && source != Source::kGiven)) {
    source_ = source;
    work_ = work;
    version_ = version;
    if (other) built_ = nullptr;
    if (source == Source::kGiven) {
      head_ = given_.head;
    } else if (source == Source::kPhoto) {
      maker_.Ask([work, points = editor.state().points]() -> vm::Result<MadeHead> {
        auto built = BuildFace(*work, points);
        if (!built) return std::unexpected(built.error());
        return MadeHead{(*built)->head, *built, "", nullptr};
      });
    } else {
      maker_.Ask(
          [base = editor.state().base, sliders = editor.state().sliders]() -> vm::Result<MadeHead> {
            auto head = MakeIdentityHead(base, sliders);
            if (!head) return std::unexpected(head.error());
            return MadeHead{*head, nullptr, "", nullptr};
          });
    }
  }
  auto made = maker_.Take();
  if (!made) return {};
  if (!*made) return std::unexpected(made->error());
  // What was made for a page that was left meanwhile is not worn.
  const bool for_photo = (*made)->built != nullptr;
  if (for_photo != (source_ == Source::kPhoto) || source_ == Source::kGiven) return {};
  head_ = (*made)->head;
  built_ = (*made)->built;
  return {};
}

std::vector<Stage::Touched> Stage::TouchedBy(const fsm::UnitTable& units,
                                             const fsm::FaceState& full,
                                             const fsm::FaceState& state) const {
  constexpr float kLeast = 0.15F;  // millimetres
  std::vector<Touched> touched;
  const auto alone = head_ ? head_->WithUnits(units) : nullptr;
  if (!alone) return touched;
  fsm::HeadVertices rest, moved, now;
  alone->Evaluate({}, rest);
  alone->Evaluate(full, moved);
  head()->Evaluate(state, now);
  for (std::size_t i = 0; i < rest.position.size(); ++i) {
    const float by = glm::distance(rest.position[i], moved.position[i]);
    if (by > kLeast && now.normal[i].z > 0) touched.push_back({now.position[i], by});
  }
  return touched;
}

void Stage::Draw(const fsm::Viewport& pane, const fsm::FaceState& state) {
  if (!head_ || pane.width < 8 || pane.height < 8) return;
  fsm::FaceState turned = state;
  turned.figure.rotation = {turn[0], turn[1], 0};
  head()->Evaluate(turned, vertices_);
  renderer_->SetViewport(pane);
  renderer_->DrawVertices(*head_, vertices_, turned.figure, scene);
}

std::vector<std::pair<glm::vec2, glm::vec2>> MeshLines(const facefit::FittedHead& fitted) {
  const facefit::ObservedHead& base = *fitted.base;
  const std::vector<glm::vec3> camera = fitted.pose.ToCamera(fitted.vertices);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  facefit::ForEachSkinAndLipTriangle(base.surface(), [&](const facefit::MeshTriangle& t) {
    const glm::vec3 n = t.Normal(camera);
    // The neck is not fitted, what lies behind is not seen.
    const bool face = std::ranges::all_of(t.corner, [&](std::uint32_t v) {
      return fitted.vertices[v].z > 10 && base.rest().position[v].y > -95;
    });
    if (!face || n.z <= 0.1F * glm::length(n)) return;
    for (std::size_t c = 0; c < 3; ++c) {
      edges.emplace_back(std::minmax(t.corner[c], t.corner[(c + 1) % 3]));
    }
  });
  std::ranges::sort(edges);
  const auto rest = std::ranges::unique(edges);
  edges.erase(rest.begin(), rest.end());
  std::vector<std::pair<glm::vec2, glm::vec2>> lines;
  lines.reserve(edges.size());
  for (const auto& [a, b] : edges) {
    lines.emplace_back(fitted.pose.Project(camera[a]), fitted.pose.Project(camera[b]));
  }
  return lines;
}

}  // namespace editor

// Our head beside others, drawn by the same renderer in the same light: one row for each head, from
// the front, turned by 35 degrees and in profile.
//
//   compare_heads [--heads FOLDER] [--out FILE.png] [--face NAME]
//
// FOLDER holds ict/ and makehuman/ (neutral.obj each), which are not part of the project; what is
// not there is left out with a notice. They come without hair and textures: their skin has our
// colours, and our pores where they say where their features are.

#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bench/obj_head.h"
#include "fsm/app/contact_sheet_font.h"
#include "fsm/head/make_head.h"
#include "fsm/image/image_file.h"
#include "fsm/render/renderer.h"
#include "fsm/rig/head.h"

namespace {

using fsm::Material;

constexpr int kWidth = 420, kHeight = 480, kGap = 4, kLabel = 24;
constexpr std::array kTurns = {0.0F, 35.0F, 90.0F};

std::vector<fsm::bench::ObjSource> Sources(const std::filesystem::path& folder) {
  return {{"ICT",
           folder / "ict",
           10,
           {{"face", Material::kSkin},
            {"head_neck", Material::kSkin},
            {"mouth_socket", Material::kMouthInside},
            {"eye_sockets", Material::kSkin},
            {"gums_tongue", Material::kGum},
            {"teeth", Material::kTeeth},
            {"eyeballs", Material::kSclera}}},
          {"MAKEHUMAN",
           folder / "makehuman",
           100,
           {{"head", Material::kSkin},
            {"l-eye", Material::kSclera},
            {"r-eye", Material::kSclera},
            {"upper-teeth", Material::kTeeth},
            {"lower-teeth", Material::kTeeth},
            {"tongue", Material::kTongue}}}};
}

struct Row {
  std::string name;
  std::unique_ptr<fsm::Head> head;
};

std::vector<Row> Rows(const std::filesystem::path& folder, const std::string& face) {
  std::vector<Row> rows;
  rows.push_back({"OURS", face.empty() ? fsm::MakeHead("galatea") : fsm::MakeHead(face)});
  const auto& [right, left] = rows.front().head->rig().data().eyes.centre;
  const glm::vec3 middle = (right + left) / 2.0F;
  for (const auto& source : Sources(folder)) {
    if (!std::filesystem::exists(source.folder)) {
      std::fprintf(stderr, "compare_heads: notice: no %s, left out\n", source.folder.c_str());
      continue;
    }
    rows.push_back({source.name, fsm::bench::ReadObjHead(source, middle)});
  }
  return rows;
}

void Paste(const fsm::Image& from, fsm::Image& to, int x, int y) {
  for (int row = 0; row < from.height; ++row) {
    const auto begin = from.rgba.begin() + static_cast<std::ptrdiff_t>(4) * row * from.width;
    std::copy(begin, begin + static_cast<std::ptrdiff_t>(4) * from.width,
              to.rgba.begin() + static_cast<std::ptrdiff_t>(4) * ((y + row) * to.width + x));
  }
}

fsm::Image DrawRows(const std::vector<Row>& rows) {
  fsm::Image sheet;
  sheet.width = static_cast<int>(kTurns.size()) * (kWidth + kGap) - kGap;
  sheet.height = static_cast<int>(rows.size()) * (kHeight + kLabel);
  sheet.rgba.assign(
      4 * static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height), 235);
  for (std::size_t i = 3; i < sheet.rgba.size(); i += 4) sheet.rgba[i] = 255;
  auto context = fsm::RenderContext::MakeHeadless(kWidth, kHeight);
  auto renderer = fsm::Renderer::Make(*context);
  int y = 0;
  for (const Row& row : rows) {
    fsm::HeadVertices vertices;
    row.head->Evaluate({}, vertices);
    int x = 0;
    for (const float turn : kTurns) {
      fsm::FaceState state;
      state.figure.rotation = {0, turn, 0};
      renderer->DrawVertices(*row.head, vertices, state.figure, {});
      fsm::Image image;
      renderer->Read(image);
      Paste(image, sheet, x, y);
      x += kWidth + kGap;
    }
    const std::string label =
        row.name + ", " + std::to_string(row.head->surface().indices.size() / 3) + " TRIANGLES";
    fsm::DrawText(sheet, 6, y + kHeight + 5, 2, label);
    y += kHeight + kLabel;
  }
  return sheet;
}

int Run(int argc, char** argv) {
  std::string heads = "../shared/data/heads", out = "heads.png", face;
  for (int i = 1; i < argc; i += 2) {
    const std::string word = argv[i];
    if (i + 1 == argc || (word != "--heads" && word != "--out" && word != "--face")) {
      std::fprintf(stderr,
                   "usage: compare_heads [--heads FOLDER] [--out FILE.png] [--face NAME]\n");
      return 2;
    }
    (word == "--heads" ? heads : word == "--out" ? out : face) = argv[i + 1];
  }
  if (auto written = fsm::WriteImage(DrawRows(Rows(heads, face)), out); !written) {
    std::fprintf(stderr, "compare_heads: %s\n", written.error().text.c_str());
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return Run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "compare_heads: %s\n", error.what());
    return 1;
  }
}

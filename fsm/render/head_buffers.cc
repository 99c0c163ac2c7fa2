#include "fsm/render/head_buffers.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <utility>

namespace fsm {
namespace {

const glm::vec4 kNone(0);

/// Per vertex: of skin its texture coordinates and how much creases of the right and of the left
/// side show there; of hair its place among hairs, direction with density, and place across a lock.
struct Detail {
  std::vector<glm::vec2> place;
  std::vector<glm::vec4> right, left;
};

Detail DetailOf(const HeadTopology& topology, const CreaseWeights& creases, std::size_t count) {
  Detail detail{topology.uv, creases.right, creases.left};
  detail.place.resize(count);
  detail.right.resize(count);
  detail.left.resize(count);
  for (const auto& part : topology.parts) {
    if (!IsHair(part.material)) continue;
    for (std::uint32_t k = part.first_index; k < part.first_index + part.index_count; ++k) {
      const auto i = topology.indices[k];
      const Strand strand = i < topology.strands.size() ? topology.strands[i] : Strand{};
      detail.place[i] = strand.tile_mm;
      detail.right[i] = glm::vec4(strand.along, strand.density);
      detail.left[i] = glm::vec4(strand.across, 0, 0, 0);
    }
  }
  return detail;
}

/// Per vertex: colour and openness to light; where in the photo it is, the photo's part in the
/// colour and how much is lid; of lids what ShutLid says of grain and slide; opacity.
struct Paint {
  std::vector<glm::vec4> colour, worn, grain;
  std::vector<float> opacity;
};

Paint PaintOf(const HeadTopology& topology) {
  const std::size_t count = topology.albedo.size();
  Paint paint{std::vector<glm::vec4>(count), std::vector<glm::vec4>(count, kNone),
              std::vector<glm::vec4>(count, kNone), topology.opacity};
  paint.opacity.resize(count, 1.0F);
  for (std::size_t i = 0; i < count; ++i) {
    paint.colour[i] = glm::vec4(topology.albedo[i], topology.occlusion[i]);
  }
  for (std::size_t i = 0; i < topology.worn.texcoord.size(); ++i) {
    paint.worn[i] = glm::vec4(topology.worn.texcoord[i], topology.worn.weight[i], 0);
  }
  for (const ShutLid& lid : topology.portrait.shut_lids) {
    paint.colour[lid.vertex] = glm::vec4(lid.colour, lid.grain_light);
    paint.worn[lid.vertex].w = lid.weight;
    paint.grain[lid.vertex] = glm::vec4(lid.grain_at, lid.slide);
  }
  return paint;
}

/// Of every vertex, how much is more than the photo.
std::vector<Worn> WornBy(const Paint& paint, const Detail& detail) {
  std::vector<Worn> worn(paint.opacity.size());
  for (std::size_t i = 0; i < worn.size(); ++i) {
    const bool creases = detail.right[i] != kNone || detail.left[i] != kNone;
    worn[i] = paint.opacity[i] < 1 || paint.grain[i].x > 0 ? Worn::kDetailed
              : creases                                    ? Worn::kCreased
                                                           : Worn::kPlain;
  }
  return worn;
}

/// How fine the photo lies on what wears it and faces the viewer, as he sees it: the root of texels
/// to square millimetres.
float TexelsPerMm(const HeadTopology& topology, const HeadVertices& rest) {
  if (!topology.worn.image || topology.worn.texcoord.empty()) return 0;
  const glm::vec2 size(topology.worn.image->width, topology.worn.image->height);
  double texels = 0, area = 0;
  for (std::size_t k = 0; k + 2 < topology.indices.size(); k += 3) {
    const auto* t = &topology.indices[k];
    if (std::min({topology.worn.weight[t[0]], topology.worn.weight[t[1]],
                  topology.worn.weight[t[2]]}) <= 0) {
      continue;
    }
    const glm::vec2 a = size * (topology.worn.texcoord[t[1]] - topology.worn.texcoord[t[0]]);
    const glm::vec2 b = size * (topology.worn.texcoord[t[2]] - topology.worn.texcoord[t[0]]);
    const glm::vec2 c(rest.position[t[1]] - rest.position[t[0]]);
    const glm::vec2 d(rest.position[t[2]] - rest.position[t[0]]);
    const float seen = c.x * d.y - c.y * d.x;
    if (seen <= 0) continue;
    texels += std::abs(a.x * b.y - a.y * b.x);
    area += seen;
  }
  return area > 0 ? static_cast<float>(std::sqrt(texels / area)) : 0.0F;
}

}  // namespace

HeadBuffers::HeadBuffers(const GlFunctions& gl, const Head& head) : gl_(gl) {
  gl_.GenVertexArrays(1, &array_);
  gl_.GenBuffers(kAttributes + 1, buffers_);
  gl_.BindVertexArray(array_);
  constexpr GLint sizes[kAttributes] = {3, 3, 3, 4, 2, 4, 4, 4, 4, 1, 3};
  for (GLuint i = 0; i < kAttributes; ++i) {
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[i]);
    gl_.VertexAttribPointer(i, sizes[i], GL_FLOAT, GL_FALSE, 0, nullptr);
    gl_.EnableVertexAttribArray(i);
  }
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[kAttributes]);
  UploadTopology(head);
}

HeadBuffers::~HeadBuffers() {
  gl_.DeleteVertexArrays(1, &array_);
  gl_.DeleteBuffers(kAttributes + 1, buffers_);
}

void HeadBuffers::Upload(const HeadVertices& vertices) {
  gl_.BindVertexArray(array_);
  assert(vertices.position.size() == vertex_count_);
  assert(vertices.normal.size() == vertices.position.size());
  const auto bytes = static_cast<GLsizeiptr>(vertices.position.size() * sizeof(glm::vec3));
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
  gl_.BufferData(GL_ARRAY_BUFFER, bytes, vertices.position.data(), GL_STREAM_DRAW);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[1]);
  gl_.BufferData(GL_ARRAY_BUFFER, bytes, vertices.normal.data(), GL_STREAM_DRAW);
  Use(buffers_[0], buffers_[1]);
}

void HeadBuffers::Use(GLuint positions, GLuint normals) {
  gl_.BindVertexArray(array_);
  const std::array wanted{positions, normals};
  if (std::exchange(used_, wanted) == wanted) return;
  for (GLuint i = 0; i < 2; ++i) {
    gl_.BindBuffer(GL_ARRAY_BUFFER, wanted[i]);
    gl_.VertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  }
}

std::vector<std::uint32_t> HeadBuffers::MeasuredVertices() const {
  std::vector<std::uint32_t> vertices;
  eyes_.AppendVertices(vertices);
  shadows_.AppendVertices(vertices);
  mouth_.AppendVertices(vertices);
  return vertices;
}

void HeadBuffers::UploadTopology(const Head& head) {
  const auto& topology = head.topology();
  HeadVertices rest;
  head.Evaluate(FaceState{}, rest);
  assert(topology.occlusion.size() == topology.albedo.size());
  assert(rest.position.size() == topology.albedo.size());
  vertex_count_ = rest.position.size();
  CopyTopology(topology);
  photo_texels_per_mm_ = TexelsPerMm(topology, rest);
  const auto marks = FaceMarks::Of(head);
  chin_y_ = marks ? marks->gnathion.y : kNoChin;
  if (marks && topology.uv.size() == vertex_count_) {
    creases_ = WeighCreases(rest, *marks);
    painting_ = std::async(std::launch::async, [topology, rest, marks = *marks] {
      return PaintSkin(topology, rest, marks);
    });
  }
  const Detail detail = DetailOf(topology, creases_, vertex_count_);
  const Paint paint = PaintOf(topology);
  // As long as the light on it changes.
  std::vector<glm::vec3> rest_normal = rest.normal;
  for (std::size_t i = 0; i < rest_normal.size(); ++i) {
    rest_normal[i] *= i < topology.portrait.relit.size() ? topology.portrait.relit[i] : 0.0F;
  }
  const auto upload = [this](GLuint attribute, const auto& items) {
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[attribute]);
    gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(items.size() * sizeof(items[0])),
                   items.data(), GL_STATIC_DRAW);
  };
  upload(2, rest.position);
  upload(3, paint.colour);
  upload(4, detail.place);
  upload(5, detail.right);
  upload(6, detail.left);
  upload(7, paint.worn);
  upload(8, paint.grain);
  upload(9, paint.opacity);
  upload(10, rest_normal);
  worn_ = WornBy(paint, detail);
  AddLevel(kFinest, topology, {topology.parts, topology.indices}, rest.position);
  eyes_ = EyeFinder(topology, rest);
  if (eyes_.found()) resting_eyes_ = eyes_.Measure(rest);
  shadows_ = ShadowFinder(topology, rest);
  mouth_ = MouthFinder(topology);
}

void HeadBuffers::AddLevel(int level, const HeadTopology& topology, const HeadTriangles& triangles,
                           std::span<const glm::vec3> rest) {
  const DrawOrder order(topology, triangles, rest, worn_);
  auto& parts = levels_[level];
  for (DrawnPart drawn : order.parts) {
    drawn.part.first_index += static_cast<std::uint32_t>(indices_.size());
    parts.push_back(drawn);
  }
  indices_.insert(indices_.end(), order.indices.begin(), order.indices.end());
  gl_.BindVertexArray(array_);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(indices_.size() * sizeof(std::uint32_t)), indices_.data(),
                 GL_STATIC_DRAW);
}

const std::vector<DrawnPart>& HeadBuffers::Parts(const Head& head, float error_mm) {
  // Finer than the first nothing is left out; coarser than the last skin comes through short hair.
  constexpr int kFirst = -6, kLast = -1;
  const auto error_of = [](int level) { return std::exp2(0.5F * static_cast<float>(level)); };
  if (error_mm < error_of(kFirst)) return parts();
  int level = kFirst;
  while (level < kLast && error_of(level + 1) <= error_mm) ++level;
  if (!levels_.contains(level)) {
    AddLevel(level, head.topology(), CoarseTriangles(head, creases_, error_of(level)),
             head.rig().data().rest);
  }
  return levels_.at(level);
}

void HeadBuffers::CopyTopology(const HeadTopology& topology) {
  photo_ = topology.worn.image;
  normal_map_ = topology.worn.normal_map;
  emissive_map_ = topology.worn.emissive_map;
  pbr_materials_ = topology.pbr_materials;
  saturation_ = topology.portrait.saturation;
  photo_light_ = topology.portrait.light;
  eye_pictures_ = topology.portrait.eyes;
  eye_geometry_ = topology.eyes.right;
  blends_ = DrawOrder::Blends(topology);
}

const SkinTexture* HeadBuffers::skin() {
  if (painting_.valid()) skin_ = painting_.get();
  return skin_ ? &*skin_ : nullptr;
}

}  // namespace fsm

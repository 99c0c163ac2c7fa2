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

/// The vertex attributes kDetailTexcoord, kDetail and kDetailMore, per vertex.
struct DetailAttributes {
  std::vector<glm::vec2> texcoord;
  std::vector<glm::vec4> detail;
  std::vector<glm::vec2> more;
};

DetailAttributes DetailOf(const HeadTopology& topology, const CreaseWeights& creases,
                          std::size_t count) {
  DetailAttributes detail{topology.uv, creases.face, creases.nose_and_left};
  detail.texcoord.resize(count);
  detail.detail.resize(count);
  detail.more.resize(count);
  for (const auto& part : topology.parts) {
    if (!IsHair(part.material)) continue;
    for (const std::uint32_t i : topology.Corners(part)) {
      const Strand strand = i < topology.strands.size() ? topology.strands[i] : Strand{};
      detail.texcoord[i] = strand.tile_mm;
      detail.detail[i] = glm::vec4(strand.along, strand.density);
      // Single hairs cross the outline, where all others thin out, and linings do so in part.
      const float across = std::abs(strand.across);
      const bool thins = part.material == Material::kHair && i < topology.strands.size();
      detail.more[i] = glm::vec2(strand.across, !thins ? 0 : across < 1 ? 1 - 2 * across : 1);
    }
  }
  return detail;
}

/// The vertex attributes kAlbedoOpenness, kTexcoord, kLidGrain, kOpacity and kLidSkin, per vertex.
struct PaintAttributes {
  std::vector<glm::vec4> colour, texcoord, lid_grain;
  std::vector<float> opacity;
  std::vector<glm::vec2> lid_skin;
};

PaintAttributes PaintOf(const HeadTopology& topology) {
  const std::size_t count = topology.albedo.size();
  PaintAttributes paint{std::vector<glm::vec4>(count), std::vector<glm::vec4>(count, kNone),
                        std::vector<glm::vec4>(count, kNone), topology.opacity,
                        std::vector<glm::vec2>(count, glm::vec2(0))};
  paint.opacity.resize(count, 1.0F);
  for (std::size_t i = 0; i < count; ++i) {
    paint.colour[i] = glm::vec4(topology.albedo[i], topology.openness[i]);
  }
  for (std::size_t i = 0; i < topology.textures.texcoord.size(); ++i) {
    paint.texcoord[i] = glm::vec4(topology.textures.texcoord[i], topology.textures.weight[i], 0);
  }
  for (const ShutLid& lid : topology.portrait.shut_lids) {
    paint.colour[lid.vertex] = glm::vec4(lid.colour, topology.openness[lid.vertex]);
    paint.texcoord[lid.vertex].w = lid.weight;
    paint.lid_grain[lid.vertex] = glm::vec4(lid.grain_at, lid.slide);
    paint.lid_skin[lid.vertex] = glm::vec2(1, lid.grain_light);
  }
  return paint;
}

std::vector<SkinDetail> SkinDetailOf(const PaintAttributes& paint, const DetailAttributes& detail) {
  std::vector<SkinDetail> out(paint.opacity.size(), SkinDetail::kPlain);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (detail.detail[i] != kNone || detail.more[i] != glm::vec2(0)) out[i] = SkinDetail::kCreased;
    if (paint.opacity[i] < 1 || paint.lid_skin[i].x > 0) out[i] = SkinDetail::kDetailed;
  }
  return out;
}

/// Returns the photo's resolution on surfaces that face the viewer, as seen from the front: the
/// square root of texels per square millimetre.
float TexelsPerMm(const HeadTopology& topology, const HeadVertices& rest) {
  const Image* image = topology.textures.image.get();
  const auto& texcoord = topology.textures.texcoord;
  const auto& weight = topology.textures.weight;
  if (!image || texcoord.empty()) return 0;
  const glm::vec2 size(image->width, image->height);
  double texels = 0, area = 0;
  for (std::size_t k = 0; k + 2 < topology.indices.size(); k += 3) {
    const auto* t = &topology.indices[k];
    if (std::min({weight[t[0]], weight[t[1]], weight[t[2]]}) <= 0) continue;
    const glm::vec2 a = size * (texcoord[t[1]] - texcoord[t[0]]);
    const glm::vec2 b = size * (texcoord[t[2]] - texcoord[t[0]]);
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

HeadBuffers::HeadBuffers(const GlFunctions& gl, const Head& head, const Appearance& appearance)
    : gl_(gl), topology_(head.shared_topology()) {
  HeadVertices rest;
  head.Evaluate(FaceState{}, rest);
  assert(topology().openness.size() == topology().albedo.size());
  assert(rest.position.size() == topology().albedo.size());
  photo_texels_per_mm_ = TexelsPerMm(topology(), rest);
  if (const auto landmarks = FaceLandmarks::Of(head)) {
    chin_y_ = landmarks->gnathion.y;
    if (topology().uv.size() == rest.position.size()) {
      creases_ = WeighCreases(rest, *landmarks, appearance);
      painting_ = std::async(std::launch::async,
                             [topology = topology_, rest, landmarks = *landmarks, &appearance] {
                               return PaintSkin(*topology, rest, landmarks, appearance);
                             });
    }
  }
  UploadAttributes(rest);
  gl_.GenBuffers(1, &index_buffer_);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_);
  AddLevel(kFinest, {topology().parts, topology().indices}, rest.position);
  eyes_ = EyeFinder(topology(), rest);
  if (eyes_.found()) resting_eyes_ = eyes_.Measure(rest);
  shadows_ = ShadowFinder(topology(), rest);
  mouth_ = MouthFinder(topology());
}

HeadBuffers::~HeadBuffers() {
  gl_.DeleteVertexArrays(1, &array_);
  gl_.DeleteBuffers(VertexAttribute::kCount, buffers_.data());
  gl_.DeleteBuffers(1, &index_buffer_);
}

void HeadBuffers::Upload(const HeadVertices& vertices) {
  gl_.BindVertexArray(array_);
  assert(vertices.position.size() == topology().albedo.size());
  assert(vertices.normal.size() == vertices.position.size());
  const GLuint positions = buffers_[VertexAttribute::kPosition];
  const GLuint normals = buffers_[VertexAttribute::kNormal];
  const auto bytes = static_cast<GLsizeiptr>(vertices.position.size() * sizeof(glm::vec3));
  gl_.BindBuffer(GL_ARRAY_BUFFER, positions);
  gl_.BufferData(GL_ARRAY_BUFFER, bytes, vertices.position.data(), GL_STREAM_DRAW);
  gl_.BindBuffer(GL_ARRAY_BUFFER, normals);
  gl_.BufferData(GL_ARRAY_BUFFER, bytes, vertices.normal.data(), GL_STREAM_DRAW);
  Use(positions, normals);
}

void HeadBuffers::Use(GLuint positions, GLuint normals, std::size_t from) {
  gl_.BindVertexArray(array_);
  const std::array<std::size_t, 3> wanted{positions, normals, from};
  if (std::exchange(used_, wanted) == wanted) return;
  const auto point = [&](GLuint attribute, GLuint buffer) {
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer);
    gl_.VertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, 0,
                            reinterpret_cast<const void*>(from));
  };
  point(VertexAttribute::kPosition, positions);
  point(VertexAttribute::kNormal, normals);
}

std::vector<std::uint32_t> HeadBuffers::MeasuredVertices() const {
  std::vector<std::uint32_t> vertices;
  eyes_.AppendVertices(vertices);
  shadows_.AppendVertices(vertices);
  mouth_.AppendVertices(vertices);
  return vertices;
}

void HeadBuffers::UploadAttributes(const HeadVertices& rest) {
  gl_.GenVertexArrays(1, &array_);
  gl_.GenBuffers(VertexAttribute::kCount, buffers_.data());
  gl_.BindVertexArray(array_);
  for (GLuint i = 0; i < VertexAttribute::kCount; ++i) {
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[i]);
    gl_.VertexAttribPointer(i, VertexAttribute::kWidth[i], GL_FLOAT, GL_FALSE, 0, nullptr);
    gl_.EnableVertexAttribArray(i);
  }
  const auto upload = [this](VertexAttribute::Location attribute, const auto& items) {
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[attribute]);
    gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(items.size() * sizeof(items[0])),
                   items.data(), GL_STATIC_DRAW);
  };
  const DetailAttributes detail = DetailOf(topology(), creases_, rest.position.size());
  const PaintAttributes paint = PaintOf(topology());
  std::vector<glm::vec3> relit_normal = rest.normal;
  for (std::size_t i = 0; i < relit_normal.size(); ++i) {
    relit_normal[i] *= i < topology().portrait.relit.size() ? topology().portrait.relit[i] : 0.0F;
  }
  upload(VertexAttribute::kRestPosition, rest.position);
  upload(VertexAttribute::kAlbedoOpenness, paint.colour);
  upload(VertexAttribute::kDetailTexcoord, detail.texcoord);
  upload(VertexAttribute::kDetail, detail.detail);
  upload(VertexAttribute::kDetailMore, detail.more);
  upload(VertexAttribute::kTexcoord, paint.texcoord);
  upload(VertexAttribute::kLidGrain, paint.lid_grain);
  upload(VertexAttribute::kLidSkin, paint.lid_skin);
  upload(VertexAttribute::kOpacity, paint.opacity);
  upload(VertexAttribute::kRelitNormal, relit_normal);
  skin_detail_ = SkinDetailOf(paint, detail);
}

void HeadBuffers::AddLevel(int level, const HeadTriangles& triangles,
                           std::span<const glm::vec3> rest) {
  const DrawOrder order = OrderToDraw(topology(), triangles, rest, skin_detail_);
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

const std::vector<DrawnPart>& HeadBuffers::PartsWithin(const Head& head, float error_mm) {
  // Below kFirst nothing is removed; above kLast skin shows through short hair.
  constexpr int kFirst = -6, kLast = -1;
  const auto error_of = [](int level) { return std::exp2(0.5F * static_cast<float>(level)); };
  if (error_mm < error_of(kFirst)) return FinestParts();
  int level = kFirst;
  while (level < kLast && error_of(level + 1) <= error_mm) ++level;
  if (!levels_.contains(level)) {
    AddLevel(level, CoarseTriangles(head, creases_, error_of(level)), head.rig().data().rest);
  }
  return levels_.at(level);
}

const SkinTexture* HeadBuffers::skin() {
  if (painting_.valid()) skin_ = painting_.get();
  return skin_ ? &*skin_ : nullptr;
}

}  // namespace fsm

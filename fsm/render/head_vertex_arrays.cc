#include "fsm/render/head_vertex_arrays.h"

#include <array>
#include <cassert>
#include <cmath>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <utility>

namespace fsm {
namespace {

const glm::vec4 kZero(0);

/// The vertex attributes kDetailTexcoord, kDetail and kDetailMore, per vertex.
struct DetailAttributes {
  std::vector<glm::vec2> texcoord;
  std::vector<glm::vec4> detail;
  std::vector<glm::vec3> more;
};

DetailAttributes DetailOf(const HeadSurface& surface, const CreaseWeights& creases,
                          std::size_t count) {
  DetailAttributes detail{surface.uv, creases.face, creases.more};
  detail.texcoord.resize(count);
  detail.detail.resize(count);
  detail.more.resize(count);
  for (const auto& part : surface.parts) {
    if (!IsHair(part.material)) continue;
    for (const std::uint32_t i : surface.Corners(part)) {
      const Strand strand = i < surface.strands.size() ? surface.strands[i] : Strand{};
      detail.texcoord[i] = strand.tile_mm;
      detail.detail[i] = glm::vec4(strand.along, strand.density);
      // Single hairs cross the outline, where all others thin out, and linings do so in part.
      const float across = std::abs(strand.across);
      const bool thins = part.material == Material::kHair && i < surface.strands.size();
      detail.more[i] = glm::vec3(strand.across, !thins ? 0 : across < 1 ? 1 - 2 * across : 1, 0);
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

PaintAttributes PaintOf(const HeadSurface& surface) {
  const std::size_t count = surface.albedo.size();
  PaintAttributes paint{std::vector<glm::vec4>(count), std::vector<glm::vec4>(count, kZero),
                        std::vector<glm::vec4>(count, kZero), surface.opacity,
                        std::vector<glm::vec2>(count, glm::vec2(0))};
  paint.opacity.resize(count, 1.0f);
  for (std::size_t i = 0; i < count; ++i) {
    paint.colour[i] = glm::vec4(surface.albedo[i], surface.openness[i]);
  }
  for (std::size_t i = 0; i < surface.textures.texcoord.size(); ++i) {
    paint.texcoord[i] = glm::vec4(surface.textures.texcoord[i], surface.textures.weight[i], 0);
  }
  for (const ShutLid& lid : surface.portrait.shut_lids) {
    paint.colour[lid.vertex] = glm::vec4(lid.colour, surface.openness[lid.vertex]);
    paint.texcoord[lid.vertex].w = lid.weight;
    paint.lid_grain[lid.vertex] = glm::vec4(lid.grain_at, lid.slide);
    paint.lid_skin[lid.vertex] = glm::vec2(1, lid.grain_light);
  }
  return paint;
}

std::vector<SkinDetail> SkinDetailOf(const PaintAttributes& paint, const DetailAttributes& detail) {
  std::vector<SkinDetail> out(paint.opacity.size(), SkinDetail::kPlain);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (detail.detail[i] != kZero || detail.more[i] != glm::vec3(0)) out[i] = SkinDetail::kCreased;
    if (paint.opacity[i] < 1 || paint.lid_skin[i].x > 0) out[i] = SkinDetail::kDetailed;
  }
  return out;
}

}  // namespace

HeadVertexArrays::HeadVertexArrays(const GlFunctions& gl, const HeadDescription& description,
                                   const HeadVertices& rest)
    : gl_(gl), description_(description) {
  const HeadSurface& surface = *description_.surface;
  assert(surface.openness.size() == surface.albedo.size());
  assert(rest.position.size() == surface.albedo.size());
  UploadAttributes(rest);
  gl_.GenBuffers(1, &index_buffer_);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_);
  finest_ = AddParts({surface.parts, surface.indices}, rest.position);
}

HeadVertexArrays::~HeadVertexArrays() {
  gl_.DeleteVertexArrays(1, &array_);
  gl_.DeleteBuffers(VertexAttribute::kCount, buffers_.data());
  gl_.DeleteBuffers(1, &index_buffer_);
}

void HeadVertexArrays::Upload(const HeadVertices& vertices) {
  gl_.BindVertexArray(array_);
  assert(vertices.position.size() == description_.surface->albedo.size());
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

void HeadVertexArrays::Use(GLuint positions, GLuint normals, std::size_t from) {
  gl_.BindVertexArray(array_);
  const UsedBuffers wanted{positions, normals, from};
  if (std::exchange(used_, wanted) == wanted) return;
  const auto point = [&](GLuint attribute, GLuint buffer) {
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer);
    gl_.VertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, 0,
                            reinterpret_cast<const void*>(from));
  };
  point(VertexAttribute::kPosition, positions);
  point(VertexAttribute::kNormal, normals);
}

void HeadVertexArrays::UploadAttributes(const HeadVertices& rest) {
  gl_.GenVertexArrays(1, &array_);
  gl_.GenBuffers(VertexAttribute::kCount, buffers_.data());
  gl_.BindVertexArray(array_);
  for (GLuint i = 0; i < VertexAttribute::kCount; ++i) {
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[i]);
    gl_.VertexAttribPointer(i, VertexAttribute::kWidth[i], GL_FLOAT, GL_FALSE, 0, nullptr);
    gl_.EnableVertexAttribArray(i);
  }
  const auto upload = [this](VertexAttribute::Location attribute, const auto& items) {
    assert(std::cmp_equal(sizeof(items[0]) / sizeof(float), VertexAttribute::kWidth[attribute]));
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[attribute]);
    gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(items.size() * sizeof(items[0])),
                   items.data(), GL_STATIC_DRAW);
  };
  const HeadSurface& surface = *description_.surface;
  const DetailAttributes detail = DetailOf(surface, description_.creases, rest.position.size());
  const PaintAttributes paint = PaintOf(surface);
  std::vector<glm::vec3> relit_normal = rest.normal;
  for (std::size_t i = 0; i < relit_normal.size(); ++i) {
    relit_normal[i] *= i < surface.portrait.relit.size() ? surface.portrait.relit[i] : 0.0f;
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

std::vector<DrawnPart> HeadVertexArrays::AddParts(const HeadTriangles& triangles,
                                                  std::span<const glm::vec3> rest) {
  DrawOrder order = OrderToDraw(*description_.surface, triangles, rest, skin_detail_);
  for (DrawnPart& drawn : order.parts) {
    drawn.part.first_index += static_cast<std::uint32_t>(indices_.size());
  }
  indices_.insert(indices_.end(), order.indices.begin(), order.indices.end());
  gl_.BindVertexArray(array_);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(indices_.size() * sizeof(std::uint32_t)), indices_.data(),
                 GL_STATIC_DRAW);
  return std::move(order.parts);
}

const std::vector<DrawnPart>& HeadVertexArrays::PartsWithin(const Head& head, float error_mm) {
  // Below kFirst nothing is removed; above kLast skin shows through short hair.
  constexpr int kFirst = -6, kLast = -1;
  const auto error_of = [](int level) { return std::exp2(0.5f * static_cast<float>(level)); };
  if (error_mm < error_of(kFirst)) return FinestParts();
  int level = kFirst;
  while (level < kLast && error_of(level + 1) <= error_mm) ++level;
  const auto [found, missing] = levels_.try_emplace(level);
  if (missing) {
    found->second = AddParts(CoarseTriangles(head, description_.creases, error_of(level)),
                             head.rig().data().rest);
  }
  return found->second;
}

}  // namespace fsm

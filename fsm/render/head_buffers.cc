#include "fsm/render/head_buffers.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <glm/vec4.hpp>
#include <span>

#include "fsm/render/noise_volume.h"

namespace fsm {
namespace {

std::uint64_t ChecksumOf(const HeadTopology& topology) {
  std::uint64_t sum = topology.parts.size();
  const auto add = [&sum](const auto& items) {
    sum = Checksum(items.data(), items.size() * sizeof(items[0]), sum);
  };
  add(topology.indices);
  add(topology.albedo);
  add(topology.occlusion);
  for (const auto& part : topology.parts) {
    const std::uint64_t words[] = {static_cast<std::uint64_t>(part.material), part.first_index,
                                   part.index_count};
    sum = Checksum(words, sizeof(words), sum);
  }
  return sum;
}

glm::vec3 FindCrown(const HeadTopology& topology, const HeadVertices& rest) {
  const bool hairy = std::ranges::any_of(
      topology.parts, [](const auto& part) { return part.material == Material::kHair; });
  glm::vec3 crown(0.0F, -1e9F, 0.0F);
  for (const auto& part : topology.parts) {
    if (hairy && part.material != Material::kHair) continue;
    for (const auto i : std::span(topology.indices).subspan(part.first_index, part.index_count)) {
      if (rest.position[i].y > crown.y) crown = rest.position[i];
    }
  }
  crown.x = 0;
  return crown;
}

/// Skin is never of one colour: patches of 4 and 12 millimetres, redder and paler, on the vertices
/// of skin. Here and not per pixel because it changes slowly and a fetch per pixel is dear.
void Mottle(const HeadTopology& topology, const HeadVertices& rest, std::vector<glm::vec4>& paint) {
  std::vector<bool> done(paint.size());
  for (const auto& part : topology.parts) {
    if (part.material != Material::kSkin) continue;
    for (const auto i : std::span(topology.indices).subspan(part.first_index, part.index_count)) {
      if (done[i]) continue;
      done[i] = true;
      const glm::vec3 p = rest.position[i];
      const float patch = 0.6F * NoiseAt(p / 4.0F) + 0.8F * NoiseAt(p / 12.0F + 7.5F);
      paint[i] *= 1.0F + patch * glm::vec4(0.09F, 0.17F, 0.17F, 0.0F);
    }
  }
}

}  // namespace

std::uint64_t Checksum(const void* data, std::size_t bytes, std::uint64_t start) {
  constexpr std::uint64_t kPrime = 0x100000001b3;
  std::uint64_t sum = start ^ 0xcbf29ce484222325;
  const auto* at = static_cast<const unsigned char*>(data);
  for (; bytes >= 8; bytes -= 8, at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, at, 8);
    sum = (sum ^ word) * kPrime;
    sum ^= sum >> 29;
  }
  for (; bytes > 0; --bytes) sum = (sum ^ *at++) * kPrime;
  return sum;
}

HeadBuffers::HeadBuffers(const GlFunctions& gl) : gl_(gl) {
  gl_.GenVertexArrays(1, &array_);
  gl_.GenBuffers(5, buffers_);
  gl_.BindVertexArray(array_);
  const GLint sizes[] = {3, 3, 3, 4};
  for (GLuint i = 0; i < 4; ++i) {
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[i]);
    gl_.VertexAttribPointer(i, sizes[i], GL_FLOAT, GL_FALSE, 0, nullptr);
    gl_.EnableVertexAttribArray(i);
  }
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[4]);
}

HeadBuffers::~HeadBuffers() {
  gl_.DeleteVertexArrays(1, &array_);
  gl_.DeleteBuffers(5, buffers_);
}

void HeadBuffers::Upload(const Head& head, const HeadVertices& vertices) {
  const auto checksum = ChecksumOf(head.topology());
  gl_.BindVertexArray(array_);
  if (&head != head_ || checksum != checksum_) {
    UploadTopology(head);
    head_ = &head;
    checksum_ = checksum;
  }
  assert(vertices.position.size() == head.topology().albedo.size());
  assert(vertices.normal.size() == vertices.position.size());
  const auto bytes = static_cast<GLsizeiptr>(vertices.position.size() * sizeof(glm::vec3));
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
  gl_.BufferData(GL_ARRAY_BUFFER, bytes, vertices.position.data(), GL_STREAM_DRAW);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[1]);
  gl_.BufferData(GL_ARRAY_BUFFER, bytes, vertices.normal.data(), GL_STREAM_DRAW);
}

void HeadBuffers::UploadTopology(const Head& head) {
  const auto& topology = head.topology();
  HeadVertices rest;
  head.Evaluate(FaceState{}, rest);
  assert(topology.occlusion.size() == topology.albedo.size());
  assert(rest.position.size() == topology.albedo.size());
  std::vector<glm::vec4> paint(topology.albedo.size());
  for (std::size_t i = 0; i < paint.size(); ++i) {
    paint[i] = glm::vec4(topology.albedo[i], topology.occlusion[i]);
  }
  Mottle(topology, rest, paint);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[2]);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(rest.position.size() * sizeof(glm::vec3)),
                 rest.position.data(), GL_STATIC_DRAW);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[3]);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(paint.size() * sizeof(glm::vec4)),
                 paint.data(), GL_STATIC_DRAW);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(topology.indices.size() * sizeof(std::uint32_t)),
                 topology.indices.data(), GL_STATIC_DRAW);
  eyes_ = EyeFinder(topology, rest);
  shadows_ = ShadowFinder(topology, rest);
  crown_ = FindCrown(topology, rest);
}

}  // namespace fsm

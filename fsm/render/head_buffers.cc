#include "fsm/render/head_buffers.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <functional>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <tuple>
#include <utility>

namespace fsm {
namespace {

/// Whether nothing is seen through a triangle. `cut_out`: it is not there where the photo is not.
bool HidesAll(const HeadTopology& topology, std::span<const std::uint32_t> triangle, bool cut_out) {
  glm::vec2 low(1e9F), high(-1e9F);
  for (const std::uint32_t v : triangle) {
    if (topology.opacity[v] < 1) return false;
    low = glm::min(low, topology.texcoord[v]);
    high = glm::max(high, topology.texcoord[v]);
  }
  if (!cut_out) return true;
  const Image& photo = *topology.photo;
  const glm::ivec2 last(photo.width - 1, photo.height - 1);
  const glm::vec2 size(photo.width, photo.height);
  const auto from = glm::clamp(glm::ivec2(low * size) - 1, glm::ivec2(0), last);
  const auto to = glm::clamp(glm::ivec2(high * size) + 1, glm::ivec2(0), last);
  for (int y = from.y; y <= to.y; ++y) {
    for (int x = from.x; x <= to.x; ++x) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(photo.width) +
                     static_cast<std::size_t>(x);
      if (photo.rgba[4 * i + 3] < 250) return false;
    }
  }
  return true;
}

const glm::vec4 kNone(0);

/// Of every vertex: of skin its unrolled place and how much creases of the right and of the left
/// side show there; of hair its place among hairs, direction with density, and place across a lock.
struct Detail {
  std::vector<glm::vec2> place;
  std::vector<glm::vec4> right, left;
};

Detail DetailOf(const HeadTopology& topology, CreaseWeights creases, std::size_t count) {
  Detail detail{topology.uv, std::move(creases.right), std::move(creases.left)};
  detail.place.resize(count);
  detail.right.resize(count);
  detail.left.resize(count);
  for (const auto& part : topology.parts) {
    if (!IsHair(part.material)) continue;
    for (std::uint32_t k = part.first_index; k < part.first_index + part.index_count; ++k) {
      const auto i = topology.indices[k];
      const Strand strand = i < topology.strands.size() ? topology.strands[i] : Strand{};
      detail.place[i] = strand.place;
      detail.right[i] = glm::vec4(strand.along, strand.density);
      detail.left[i] = glm::vec4(strand.across, 0, 0, 0);
    }
  }
  return detail;
}

/// Of every vertex: colour and openness to light; where in the photo it is, the photo's part in the
/// colour and how much is lid; of lids what ShutLid says of the lender and its way; opacity.
struct Paint {
  std::vector<glm::vec4> colour, worn, lender;
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
  for (std::size_t i = 0; i < topology.texcoord.size(); ++i) {
    paint.worn[i] = glm::vec4(topology.texcoord[i], topology.texture_weight[i], 0);
  }
  for (const ShutLid& lid : topology.shut_lids) {
    paint.colour[lid.vertex] = glm::vec4(lid.colour, lid.lender_light);
    paint.worn[lid.vertex].w = lid.weight;
    paint.lender[lid.vertex] = glm::vec4(lid.lender, lid.slide);
  }
  return paint;
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
  TakeOver(topology);
  const auto marks = FaceMarks::Of(head);
  CreaseWeights creases;
  chin_y_ = marks ? marks->gnathion.y : kNoChin;
  if (marks && topology.uv.size() == vertex_count_) {
    creases = WeighCreases(rest, *marks);
    painting_ = std::async(std::launch::async, [topology, rest, marks = *marks] {
      return PaintSkin(topology, rest, marks);
    });
  }
  const Detail detail = DetailOf(topology, std::move(creases), vertex_count_);
  const Paint paint = PaintOf(topology);
  // As long as the light on it changes.
  std::vector<glm::vec3> rest_normal = rest.normal;
  for (std::size_t i = 0; i < rest_normal.size(); ++i) {
    rest_normal[i] *= i < topology.relit.size() ? topology.relit[i] : 0.0F;
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
  upload(8, paint.lender);
  upload(9, paint.opacity);
  upload(10, rest_normal);
  std::vector<bool> detailed(vertex_count_);
  for (std::size_t i = 0; i < detailed.size(); ++i) {
    detailed[i] = paint.opacity[i] < 1 || paint.lender[i].x > 0 || detail.right[i] != kNone ||
                  detail.left[i] != kNone;
  }
  Order(topology, rest, detailed);
  eyes_ = EyeFinder(topology, rest);
  if (eyes_.found()) resting_eyes_ = eyes_.Measure(rest);
  shadows_ = ShadowFinder(topology, rest);
  mouth_ = MouthFinder(topology);
}

void HeadBuffers::TakeOver(const HeadTopology& topology) {
  photo_ = topology.photo;
  normal_map_ = topology.normal_map;
  emissive_map_ = topology.emissive_map;
  pbr_materials_ = topology.pbr_materials;
  saturation_ = topology.saturation;
  photo_light_ = topology.photo_light;
  eye_pictures_ = topology.eye_pictures;
  eye_place_ = topology.eyes[0];
  // What wears a photo thins out as hair does; a mesh from elsewhere has cut-outs in any order.
  blends_ = Blends(topology);
}

const SkinTexture* HeadBuffers::skin() {
  if (painting_.valid()) skin_ = painting_.get();
  return skin_ ? &*skin_ : nullptr;
}

// Pixels found to be hidden cost nearly nothing, so the hair before the ears comes first, then the
// face, then the hair behind it, each from the front to the back of a head that looks at the
// viewer. Which is right most of the time, and where it is not only time is lost.
void HeadBuffers::Order(const HeadTopology& topology, const HeadVertices& rest,
                        const std::vector<bool>& detailed) {
  constexpr float kBehind = 0.0F;  // the plane of the ears
  using Triangle = std::array<std::uint32_t, 3>;
  std::vector<Triangle> hair;
  std::vector<std::uint32_t> indices;
  const auto depth = [&rest](const Triangle& t) {
    return rest.position[t[0]].z + rest.position[t[1]].z + rest.position[t[2]].z;
  };
  const auto add = [&](HeadTopology::Part part, std::span<const std::uint32_t> corners,
                       bool soft = false, bool is_detailed = true) {
    if (corners.empty()) return;
    part.first_index = static_cast<std::uint32_t>(indices.size());
    part.index_count = static_cast<std::uint32_t>(corners.size());
    parts_.push_back({part, soft, is_detailed});
    indices.insert(indices.end(), corners.begin(), corners.end());
  };
  const auto add_worn = [&](const HeadTopology::Part& part,
                            std::span<const std::uint32_t> corners) {
    std::array<std::vector<std::uint32_t>, 2> lists;
    for (std::size_t k = 0; k + 2 < corners.size(); k += 3) {
      const auto t = corners.subspan(k, 3);
      auto& list = lists[std::ranges::any_of(t, [&](std::uint32_t i) { return detailed[i]; })];
      list.insert(list.end(), t.begin(), t.end());
    }
    add(part, lists[0], false, false);
    add(part, lists[1]);
  };
  const auto flat = [](std::span<const Triangle> triangles) {
    std::vector<std::uint32_t> corners;
    for (const auto& t : triangles) corners.insert(corners.end(), t.begin(), t.end());
    return corners;
  };
  for (const auto& part : topology.parts) {
    if (part.material != Material::kHair) continue;
    for (std::uint32_t k = 0; k < part.index_count; k += 3) {
      const auto* corner = &topology.indices[part.first_index + k];
      hair.push_back({corner[0], corner[1], corner[2]});
    }
  }
  // Locks lie on the shell of the hair and come before it. Equal ones by their corners, so that the
  // order is the same everywhere.
  const auto is_shell = [&topology](const Triangle& t) {
    return std::ranges::all_of(t, [&topology](std::uint32_t i) {
      return i >= topology.strands.size() || topology.strands[i].across == 0;
    });
  };
  const auto key = [&](const Triangle& t) {
    return std::tuple(depth(t) < kBehind, is_shell(t), -depth(t), t);
  };
  std::ranges::sort(hair, {}, key);
  const auto behind = std::ranges::find_if(hair, [&](const auto& t) { return depth(t) < kBehind; });
  const HeadTopology::Part locks{.material = Material::kHair, .first_index = 0, .index_count = 0};
  add(locks, flat({hair.begin(), behind}));
  HeadTopology::Part skin{}, sheet{};
  std::vector<std::uint32_t> soft_sheet, fading;
  std::vector<HeadTopology::Part> lashes;
  for (const auto& part : topology.parts) {
    if (part.material == Material::kHair) continue;
    const auto corners = std::span(topology.indices).subspan(part.first_index, part.index_count);
    const bool of_sheet = part.material == Material::kPhoto;
    if (part.material == Material::kShutLash) {
      lashes.push_back(part);
      continue;
    }
    if (!blends_ || (part.material != Material::kSkin && !of_sheet)) {
      const bool worn = photo_ && part.pbr < 0 &&
                        (part.material == Material::kSkin || part.material == Material::kLip);
      worn ? add_worn(part, corners) : add(part, corners);
      continue;
    }
    (of_sheet ? sheet : skin) = part;
    // What hides all behind it comes first: mixing costs time.
    std::vector<std::uint32_t> whole;
    for (std::size_t k = 0; k + 2 < corners.size(); k += 3) {
      const auto triangle = corners.subspan(k, 3);
      auto& list = HidesAll(topology, triangle, of_sheet) ? whole : of_sheet ? soft_sheet : fading;
      list.insert(list.end(), triangle.begin(), triangle.end());
    }
    add_worn(part, whole);
  }
  add(sheet, soft_sheet, true);
  add(skin, fading, true);
  for (const auto& part : lashes) {
    add(part, std::span(topology.indices).subspan(part.first_index, part.index_count), true);
  }
  add(locks, flat({behind, hair.end()}));
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
                 GL_STATIC_DRAW);
}

}  // namespace fsm

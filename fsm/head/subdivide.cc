#include "fsm/head/subdivide.h"

#include <algorithm>
#include <map>

namespace fsm {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

struct Edge {
  std::uint32_t a, b;
  std::array<std::uint32_t, 2> face{kNone, kNone};
  bool sharp = false;
};

struct Mesh {
  std::vector<glm::vec3> position;
  std::vector<CageTag> tag;
  std::vector<std::uint32_t> mirror;
  std::vector<Cage::Polygon> faces;
  std::vector<Edge> edges;
  std::vector<std::vector<std::uint32_t>> face_edges;    // edge k joins corners k and k + 1
  std::vector<std::vector<std::uint32_t>> vertex_edges;  // by vertex
  std::vector<std::vector<std::uint32_t>> vertex_faces;
};

Mesh Mirrored(const Cage& half) {
  Mesh mesh;
  mesh.position = half.position;
  mesh.tag = half.tag;
  mesh.faces = half.polygons;
  mesh.mirror.resize(half.position.size());
  for (std::uint32_t i = 0; i < half.position.size(); ++i) {
    if (half.position[i].x == 0) {
      mesh.mirror[i] = i;
      continue;
    }
    const auto image = static_cast<std::uint32_t>(mesh.position.size());
    mesh.mirror[i] = image;
    mesh.position.push_back(half.position[i] * glm::vec3(-1, 1, 1));
    mesh.tag.push_back(half.tag[i]);
    mesh.mirror.push_back(i);
  }
  for (const Cage::Polygon& face : half.polygons) {
    Cage::Polygon image = face;
    for (std::uint32_t& v : image.corner) v = mesh.mirror[v];
    std::ranges::reverse(image.corner);
    mesh.faces.push_back(std::move(image));
  }
  return mesh;
}

void FindEdges(Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
  mesh.vertex_edges.resize(mesh.position.size());
  mesh.vertex_faces.resize(mesh.position.size());
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& corner = mesh.faces[f].corner;
    auto& own = mesh.face_edges.emplace_back();
    for (std::size_t k = 0; k < corner.size(); ++k) {
      const std::uint32_t a = corner[k];
      const std::uint32_t b = corner[(k + 1) % corner.size()];
      const auto [entry, fresh] =
          known.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.edges.size()));
      if (fresh) {
        const bool seam = mesh.tag[a].seam == 1 && mesh.tag[b].seam == 1;
        mesh.edges.push_back({a, b, {f, kNone}, seam});
        mesh.vertex_edges[a].push_back(entry->second);
        mesh.vertex_edges[b].push_back(entry->second);
      } else {
        mesh.edges[entry->second].face[1] = f;
      }
      own.push_back(entry->second);
      mesh.vertex_faces[a].push_back(f);
    }
  }
  for (Edge& edge : mesh.edges) edge.sharp |= edge.face[1] == kNone;
}

glm::vec3 FacePoint(const Mesh& mesh, const std::vector<glm::vec3>& p, std::uint32_t f) {
  glm::vec3 sum(0);
  for (const std::uint32_t v : mesh.faces[f].corner) sum += p[v];
  return sum / static_cast<float>(mesh.faces[f].corner.size());
}

glm::vec3 VertexPoint(const Mesh& mesh, const std::vector<glm::vec3>& p, std::uint32_t v) {
  glm::vec3 sharp_ends(0);
  glm::vec3 middles(0);
  int sharp = 0;
  for (const std::uint32_t e : mesh.vertex_edges[v]) {
    const Edge& edge = mesh.edges[e];
    const std::uint32_t other = edge.a == v ? edge.b : edge.a;
    middles += 0.5f * (p[v] + p[other]);
    if (edge.sharp) {
      sharp_ends += p[other];
      ++sharp;
    }
  }
  if (sharp > 2) return p[v];
  if (sharp == 2) return 0.75f * p[v] + 0.125f * sharp_ends;
  const auto n = static_cast<float>(mesh.vertex_edges[v].size());
  glm::vec3 centres(0);
  for (const std::uint32_t f : mesh.vertex_faces[v]) centres += FacePoint(mesh, p, f);
  return (centres / n + 2.0f * middles / n + (n - 3) * p[v]) / n;
}

/// Moves the cage so that its subdivided vertices lie where the cage was.
std::vector<glm::vec3> Corrected(const Mesh& mesh) {
  std::vector<glm::vec3> p = mesh.position;
  for (int round = 0; round < 6; ++round) {
    std::vector<glm::vec3> next = p;
    for (std::uint32_t v = 0; v < p.size(); ++v) {
      if (mesh.vertex_edges[v].empty()) continue;
      next[v] += 0.7f * (mesh.position[v] - VertexPoint(mesh, p, v));
    }
    p = std::move(next);
  }
  return p;
}

CageTag Mean(const std::vector<CageTag>& tags, const std::vector<std::uint32_t>& of) {
  CageTag mean;
  mean.margin = mean.red = 0;
  const float share = 1.0f / static_cast<float>(of.size());
  bool no_margin = false;
  bool no_red = false;
  for (const std::uint32_t v : of) {
    const CageTag& t = tags[v];
    mean.eye += share * t.eye;
    mean.lid_upper += share * t.lid_upper;
    mean.lid_lower += share * t.lid_lower;
    mean.margin += share * t.margin;
    mean.lip_hold += share * t.lip_hold;
    mean.upper_lip += share * t.upper_lip;
    mean.lip_column += share * t.lip_column;
    mean.red += share * t.red;
    mean.deep += share * t.deep;
    mean.hole += share * t.hole;
    mean.seam += share * t.seam;
    no_margin |= t.margin < 0;
    no_red |= t.red < 0;
  }
  if (no_margin) mean.margin = -1;
  if (no_red) mean.red = -1;
  return mean;
}

/// Makes the fine skin of a cage: its vertices first, then those on edges, then those in faces.
class Subdivider {
 public:
  explicit Subdivider(const Cage& half)
      : mesh_(Mirrored(half)), first_mirrored_(half.polygons.size()), cage_(half.position.size()) {
    FindEdges(mesh_);
    p_ = Corrected(mesh_);
  }

  FineSkin Build() {
    vertex_id_.assign(p_.size(), kNone);
    for (std::uint32_t v = 0; v < p_.size(); ++v) {
      if (!mesh_.vertex_edges[v].empty()) {
        vertex_id_[v] = Add(VertexPoint(mesh_, p_, v), mesh_.tag[v]);
      }
    }
    AddEdgePoints();
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f) {
      mesh_.faces[f].fine ? AddFine(f) : AddPlain(f);
    }
    out_.of_cage.assign(vertex_id_.begin(),
                        vertex_id_.begin() + static_cast<std::ptrdiff_t>(cage_));
    return std::move(out_);
  }

 private:
  std::uint32_t Add(glm::vec3 at, const CageTag& tag) {
    out_.position.push_back(at);
    out_.tag.push_back(tag);
    return static_cast<std::uint32_t>(out_.position.size() - 1);
  }
  void AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, SkinKind kind) {
    out_.triangles.push_back({{a, b, c}, kind});
  }

  void AddEdgePoints() {
    edge_id_.assign(mesh_.edges.size(), kNone);
    const auto fine = [&](std::uint32_t f) { return f != kNone && mesh_.faces[f].fine; };
    for (std::size_t e = 0; e < mesh_.edges.size(); ++e) {
      const Edge& edge = mesh_.edges[e];
      if (!fine(edge.face[0]) && !fine(edge.face[1])) continue;
      glm::vec3 at = 0.5f * (p_[edge.a] + p_[edge.b]);
      if (!edge.sharp) {
        at = 0.5f * at +
             0.25f * (FacePoint(mesh_, p_, edge.face[0]) + FacePoint(mesh_, p_, edge.face[1]));
      }
      edge_id_[e] = Add(at, Mean(mesh_.tag, {edge.a, edge.b}));
    }
  }

  void AddPlain(std::uint32_t f) {
    const Cage::Polygon& face = mesh_.faces[f];
    std::vector<std::uint32_t> outline;
    for (std::size_t k = 0; k < face.corner.size(); ++k) {
      outline.push_back(vertex_id_[face.corner[k]]);
      const std::uint32_t middle = edge_id_[mesh_.face_edges[f][k]];
      if (middle != kNone) outline.push_back(middle);
    }
    if (face.corner.size() == 4 && outline.size() == 4) {
      // The mirrored half has the opposite orientation; its diagonal mirrors the first half's.
      const std::size_t from = f < first_mirrored_ ? 0 : 1;
      AddTriangle(outline[from], outline[from + 1], outline[from + 2], face.kind);
      AddTriangle(outline[from], outline[from + 2], outline[(from + 3) % 4], face.kind);
      return;
    }
    glm::vec3 middle(0);
    for (const std::uint32_t v : outline) middle += out_.position[v];
    const std::uint32_t centre =
        Add(middle / static_cast<float>(outline.size()), Mean(mesh_.tag, face.corner));
    for (std::size_t k = 0; k < outline.size(); ++k) {
      AddTriangle(centre, outline[k], outline[(k + 1) % outline.size()], face.kind);
    }
  }

  void AddFine(std::uint32_t f) {
    const Cage::Polygon& face = mesh_.faces[f];
    const std::size_t n = face.corner.size();
    const std::uint32_t centre = Add(FacePoint(mesh_, p_, f), Mean(mesh_.tag, face.corner));
    for (std::size_t k = 0; k < n; ++k) {
      const std::uint32_t before = edge_id_[mesh_.face_edges[f][(k + n - 1) % n]];
      const std::uint32_t after = edge_id_[mesh_.face_edges[f][k]];
      const std::uint32_t corner = vertex_id_[face.corner[k]];
      AddTriangle(centre, before, corner, face.kind);
      AddTriangle(centre, corner, after, face.kind);
    }
  }

  Mesh mesh_;
  std::size_t first_mirrored_, cage_;  // faces of the first half, points of the cage
  std::vector<glm::vec3> p_;           // positions of the mesh, corrected
  std::vector<std::uint32_t> vertex_id_, edge_id_;
  FineSkin out_;
};

}  // namespace

FineSkin Subdivide(const Cage& half) { return Subdivider(half).Build(); }

}  // namespace fsm

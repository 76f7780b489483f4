// The public calls that check triangulations in the plane.
#include "flaunay/verify.hpp"

#include "geometry/arguments.hpp"
#include "prove/arguments.hpp"
#include "prove/domain_proof.hpp"
#include "prove/planar_proof.hpp"

namespace flaunay {

std::string verify(const double* coordinates, const std::vector<std::size_t>& offsets,
                   const Triangulation& mesh) {
  expect(mesh.space.kind == SpaceKind::plane, "the triangulation is one in another space");
  prove::check_arrays(coordinates, offsets, mesh);
  const std::vector<std::int32_t> made = mesh.neighbors.empty()
                                             ? prove::neighbors_of(mesh.triangles, offsets.back())
                                             : std::vector<std::int32_t>();
  return prove::find_problem({coordinates, nullptr, offsets, mesh, made.empty() ? mesh.neighbors : made, {}});
}

std::string verify(const double* coordinates, const std::vector<std::size_t>& offsets,
                   const Constraints& constraints, const ConstrainedOptions& options,
                   const ConstrainedTriangulation& mesh) {
  const prove::DomainClaim claim{coordinates, offsets, constraints, options, mesh};
  prove::check_arrays(claim);
  return prove::find_problem(claim);
}

}  // namespace flaunay

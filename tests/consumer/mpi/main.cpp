// Each of three ranks has a row of a grid of points.
#include <cstdio>
#include <flaunay/mpi.hpp>
#include <vector>

int main(int argc, char** argv) {
  int provided = 0, rank = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  {
    const double y = rank;
    const std::vector<double> xy = {0, y, 1, y, 2, y};
    const flaunay::mpi::Triangulation mesh = flaunay::mpi::triangulate(MPI_COMM_WORLD, xy.data(), 3);
    const flaunay::mpi::Statistics& all = mesh.statistics;
    if (rank == 0) {
      std::printf("%llu points, %llu triangles, %zu hull vertices\n",
                  static_cast<unsigned long long>(all.points), static_cast<unsigned long long>(all.triangles),
                  mesh.hull.size());
    }
  }
  MPI_Finalize();
}

#include "planner_trajopt/smoothness.h"

#include <algorithm>

namespace planbench {

Eigen::MatrixXd InverseSmoothness(int num_inner) {
  // A is 2 on the diagonal and -1 beside it; its inverse is that of a string pulled at a point.
  Eigen::MatrixXd inverse(num_inner, num_inner);
  for (int i = 0; i < num_inner; ++i) {
    for (int k = 0; k < num_inner; ++k) {
      inverse(i, k) =
          static_cast<double>(std::min(i, k) + 1) * (num_inner - std::max(i, k)) / (num_inner + 1);
    }
  }
  return inverse;
}

}  // namespace planbench

// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/residuals/bounded_least_squares.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/QR>
#include <Eigen/SVD>

namespace pendulum {
namespace {

/// The F x F problem with columns of length 1.
class BoundedProblem {
 public:
  BoundedProblem(Eigen::MatrixXd matrix, Eigen::VectorXd value, Eigen::VectorXd lowest, Eigen::VectorXd highest)
      : matrix_(std::move(matrix)),
        value_(std::move(value)),
        lowest_(std::move(lowest)),
        highest_(std::move(highest)),
        place_(Eigen::VectorXd::Zero(matrix_.cols())) {
    for (Eigen::Index i = 0; i < matrix_.cols(); ++i) {
      if (lowest_[i] < highest_[i] && matrix_.col(i).norm() > 0) free_.push_back(i);
    }
    movable_ = free_;
  }

  Eigen::VectorXd Solve() {
    const auto most_steps = 10 * (matrix_.cols() + 1);  // equal gains could free and block a coordinate forever
    for (Eigen::Index step = 0; step < most_steps; ++step) {
      if (Move() && !Release()) break;
    }
    return place_;
  }

 private:
  /// Moves towards the minimum over the free coordinates. Returns false if one of them reaches a bound, where it then
  /// stays.
  bool Move() {
    constexpr double kDependent = 1e-9;
    if (free_.empty()) return true;
    Eigen::JacobiSVD<Eigen::MatrixXd> solver(matrix_(Eigen::all, free_), Eigen::ComputeThinU | Eigen::ComputeThinV);
    solver.setThreshold(kDependent);
    const Eigen::VectorXd way = solver.solve(value_ - matrix_ * place_);
    double share = 1;
    auto blocking = free_.end();
    for (auto i = free_.begin(); i != free_.end(); ++i) {
      const double move = way[i - free_.begin()];
      const double room = (move > 0 ? highest_ : lowest_)[*i] - place_[*i];
      if (std::abs(move) * share > std::abs(room)) {
        share = room / move;
        blocking = i;
      }
    }
    place_(free_) += share * way;
    if (blocking == free_.end()) return true;
    place_[*blocking] = (way[blocking - free_.begin()] > 0 ? highest_ : lowest_)[*blocking];
    free_.erase(blocking);
    return false;
  }

  /// Frees the coordinate with the largest gain from leaving its bound. Returns false if none gains.
  bool Release() {
    const Eigen::VectorXd pull = matrix_.transpose() * (value_ - matrix_ * place_);
    double most = 1e-10 * value_.norm();
    Eigen::Index best = -1;
    for (const Eigen::Index i : movable_) {
      if (std::find(free_.begin(), free_.end(), i) != free_.end()) continue;
      const bool inwards = pull[i] > 0 ? place_[i] < highest_[i] : place_[i] > lowest_[i];
      if (!inwards || std::abs(pull[i]) <= most) continue;
      most = std::abs(pull[i]);
      best = i;
    }
    if (best >= 0) free_.push_back(best);
    return best >= 0;
  }

  Eigen::MatrixXd matrix_;
  Eigen::VectorXd value_, lowest_, highest_, place_;
  std::vector<Eigen::Index> movable_, free_;
};

}  // namespace

Eigen::VectorXd BoundedLeastSquares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& value,
                                    const Eigen::VectorXd& lowest, const Eigen::VectorXd& highest) {
  const Eigen::Index size = matrix.cols();
  if (size == 0) return {};
  const Eigen::Index rows = std::min(matrix.rows(), size);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  Eigen::VectorXd turned = value;
  turned.applyOnTheLeft(qr.householderQ().adjoint());
  Eigen::MatrixXd root = qr.matrixR().topRows(rows).triangularView<Eigen::Upper>();
  root *= qr.colsPermutation().inverse();
  const Eigen::VectorXd norm = root.colwise().norm().unaryExpr([](double n) { return n > 0 ? n : 1; });
  root.array().rowwise() /= norm.array().transpose();
  BoundedProblem problem(root, turned.head(rows), lowest.cwiseProduct(norm), highest.cwiseProduct(norm));
  return problem.Solve().cwiseQuotient(norm).cwiseMax(lowest).cwiseMin(highest);
}

}  // namespace pendulum

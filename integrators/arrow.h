// Linear equations whose matrix has the shape of an arrow: a dense core, and blocks along the rest of the diagonal that couple
// with the core only.
//
//   | C  B |        C core x core, D block diagonal, B core x rest, E rest x core. Eliminating the blocks of D one by one makes
//   | E  D |        the work proportional to the number of blocks, instead of its cube as for a dense matrix.
#pragma once

#include <Eigen/LU>
#include <vector>

namespace softland {

class ArrowEquations {
 public:
  /// Prepares equations with `size` unknowns. The first `core` form the dense core, the others form blocks of `block` unknowns
  /// each.
  ArrowEquations(Eigen::Index size, Eigen::Index core, Eigen::Index block)
      : size_(size), core_(core), block_(block), blocks_(static_cast<std::size_t>((size - core) / block)) {}

  /// Factorises a column-major matrix of size x size; entries outside the core, the diagonal blocks and their coupling with the
  /// core are ignored. Returns false for a singular matrix.
  bool factor(const double* matrix) {
    const Eigen::Map<const Eigen::MatrixXd> a(matrix, size_, size_);
    const Eigen::Index rest = size_ - core_;
    upper_ = a.topRightCorner(core_, rest);
    eliminated_ = a.bottomLeftCorner(rest, core_);
    for (std::size_t s = 0; s < blocks_.size(); ++s) {
      const Eigen::Index at = static_cast<Eigen::Index>(s) * block_;
      blocks_[s].compute(a.block(core_ + at, core_ + at, block_, block_));
      eliminated_.middleRows(at, block_) = blocks_[s].solve(eliminated_.middleRows(at, block_)).eval();
    }
    core_equations_.compute(a.topLeftCorner(core_, core_) - upper_ * eliminated_);
    return eliminated_.allFinite() && core_equations_.matrixLU().allFinite() &&
           (core_equations_.matrixLU().diagonal().array() != 0).all();
  }

  /// Replaces the right-hand side `x` by the solution.
  void solve(double* x) const {
    Eigen::Map<Eigen::VectorXd> head(x, core_), tail(x + core_, size_ - core_);
    for (std::size_t s = 0; s < blocks_.size(); ++s) {
      auto part = tail.segment(static_cast<Eigen::Index>(s) * block_, block_);
      part = blocks_[s].solve(part).eval();
    }
    head = core_equations_.solve(head - upper_ * tail).eval();
    tail -= eliminated_ * head;
  }

 private:
  Eigen::Index size_, core_, block_;
  std::vector<Eigen::PartialPivLU<Eigen::MatrixXd>> blocks_;
  Eigen::MatrixXd upper_;       // B, the upper right part of the matrix
  Eigen::MatrixXd eliminated_;  // D^-1 E, by which the unknowns of D are eliminated
  Eigen::PartialPivLU<Eigen::MatrixXd> core_equations_;
};

}  // namespace softland

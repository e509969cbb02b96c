#include <Eigen/LU>

#include "linear/kkt_matrix.h"

namespace freeplay {
namespace {

class DenseKkt final : public KktMatrix {
 public:
  std::vector<int> set_pattern(int size, std::span<const MatrixEntry> entries) override {
    matrix_ = Eigen::MatrixXd::Zero(size, size);
    // Sizes the decomposition, so that factor() does not allocate.
    lu_ = Eigen::PartialPivLU<Eigen::MatrixXd>(Eigen::MatrixXd::Identity(size, size));
    std::vector<int> slots;
    slots.reserve(entries.size());
    for (const MatrixEntry& entry : entries) slots.push_back(entry.column * size + entry.row);
    return slots;
  }

  std::span<double> values() override { return {matrix_.data(), static_cast<std::size_t>(matrix_.size())}; }

  double factor() override {
    if (matrix_.rows() == 0) return 1.0;
    lu_.compute(matrix_);
    const auto pivots = lu_.matrixLU().diagonal().cwiseAbs();
    const double largest = pivots.maxCoeff();
    return largest > 0.0 ? pivots.minCoeff() / largest : 0.0;
  }

  void solve(std::span<const double> b, std::span<double> x) const override {
    using Vector = Eigen::VectorXd;
    Eigen::Map<Vector>(x.data(), matrix_.rows()).noalias() =
        lu_.solve(Eigen::Map<const Vector>(b.data(), matrix_.rows()));
  }

 private:
  Eigen::MatrixXd matrix_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

}  // namespace

std::unique_ptr<KktMatrix> make_dense_kkt() { return std::make_unique<DenseKkt>(); }

}  // namespace freeplay

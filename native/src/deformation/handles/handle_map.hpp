// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "deformation/handles/handle_partition.hpp"
#include "deformation/metric/sparse_factor.hpp"
#include "stiv/deformation/linear.hpp"
#include "stiv/execution.hpp"

namespace stiv {

/// From where on a handle map, M (n, m), is only approximated or not kept.
struct HandleMapLimits {
  double entries = 256e6 / sizeof(double);  ///< of M, or of the part of K^-1 that M'g needs, if it is kept
  double products = 3e10;                   ///< multiplications for the whole of M'M: a few seconds
  Index probes = 128;                       ///< of M'M, if it is not made; a multiple of 16
  double negligible = 1e-4;                 ///< entries of a large M, relative to the largest of their column
  double density = 1.0 / 16;                ///< most entries of M that are not negligible, relative to n m
};

/// How the vertices of a mesh follow its handles, u = M d: the displacements u, (n, 3), that minimise
/// u'Ku + sum pull_k |u_h(k) - d_k|^2 for displacements d, (m, 3), of the handles, with the fixed vertices held. M is
/// the same for x, y and z. Small ones are kept in full; of larger ones the part of K^-1 that M'g reads is kept if that
/// is smaller, and every other product is a solve.
class HandleMap {
 public:
  /// @param stiffness K, (n, n), positive semi-definite, and definite once a vertex of each part is held
  /// @throws InputError: see make_laplacian
  HandleMap(const HandleDefinition& definition, const Surface& mesh, const SymmetricMatrix& stiffness,
            const HandleMapLimits& limits = {});

  Index control_count() const { return static_cast<Index>(handles_.size()); }
  Index vertex_count() const { return static_cast<Index>(partition_.place.size()); }
  const HandlePartition& partition() const { return partition_; }
  const SparseFactor& factor() const { return *factor_; }       ///< of the equations of the free vertices
  const SymmetricMatrix& drive() const { return drive_; }       ///< (free, m): their right sides' derivatives
  bool keeps_answers() const { return answers_.size() > 0; }    ///< does M'g use stored columns, not a solve?
  bool is_truncated() const { return truncated_.has_value(); }  ///< does M'g leave out negligible entries of M?

  Positions follow(const Controls& d) const;          ///< M d
  SparseField pull_back(const SparseField& g) const;  ///< M'g, a row for every control

  /// M'g for each covector. Solves share passes over the factor, one column each, since a contact's covector has one
  /// direction at all of its vertices. (mathematics.md, "Laplacian editing")
  std::vector<SparseField> pull_back_all(const std::vector<SparseField>& g, const Execution& execution) const;

  /// Solves (K + pulls) u = right for the free vertices, with handles and fixed vertices at 0. `right` is (n, 3); only
  /// the rows of free vertices are read. Used by as-rigid-as-possible editing.
  Positions answer(const Positions& right) const;

  std::vector<Index> support(Index control) const;

  /// The metric with J = M, or J = S M and S'S given, (n, n).
  std::unique_ptr<Metric> metric(const MetricOptions& options, const WeightMatrix* surface_gram) const;

 private:
  template <class Block>
  Block solved(const Block& d) const;
  template <class Block>
  Block pulled(const Block& g) const;
  template <class Block>
  void pull_by_solve(const SparseField* g, std::size_t count, SparseField* covectors) const;
  void keep_in_full();
  void keep_answers(const std::vector<Index>& driven);
  Controls pulled_by_answers(const SparseField& g) const;
  ColumnBlock gram_product(const ColumnBlock& d, const WeightMatrix* surface_gram) const;
  Eigen::MatrixXd gram(const WeightMatrix* surface_gram) const;
  bool product_is_cheaper() const;
  bool pulls_by_products() const { return is_full() || keeps_answers() || is_truncated(); }
  bool is_full() const { return full_.rows() == vertex_count(); }

  HandleMapLimits limits_;
  HandlePartition partition_;
  std::vector<Index> handles_;
  bool hard_;
  SymmetricMatrix drive_;  ///< (free, m): what a handle's displacement adds to the right side
  std::unique_ptr<const SparseFactor> factor_;
  std::vector<unsigned char> needed_;  ///< of a solution, by products with the transpose of `drive_`
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> full_;  ///< M, or nothing
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>
      answers_;                            ///< (free, driven): columns of K^-1, or nothing
  std::optional<WeightMatrix> truncated_;  ///< M without negligible entries, or nothing
  SymmetricMatrix drive_of_answers_;       ///< (driven, m): the rows of `drive_` that have entries
};

}  // namespace stiv

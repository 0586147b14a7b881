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

/// Limits beyond which a handle map M, (n, m), is not stored or its metric is approximated.
struct HandleMapLimits {
  double entries = 256e6 / sizeof(double);  ///< stored entries of M, or of columns of K^-1
  double products = 3e10;                   ///< multiplications to compute M'M exactly
  Index probes = 128;                       ///< rank of the approximation of M'M otherwise; a multiple of 16
  double negligible = 1e-4;   ///< bound on dropped entries of a large M, relative to their column's largest
  double density = 1.0 / 16;  ///< largest fraction of entries of M that a truncated M stores
};

/// The linear map u = M d from displacements d, (m, 3), of the handles to displacements u, (n, 3), of the vertices. u
/// minimizes u'Ku + sum pull_k |u_h(k) - d_k|^2, with u = 0 at fixed vertices. M is the same for x, y and z. A small M
/// is stored. For a larger one, the columns of K^-1 that M'g reads are cached if they are small enough. All other
/// products are solves.
class HandleMap {
 public:
  /// @param stiffness K, (n, n), positive semi-definite, and definite once one vertex of each component is fixed
  /// @throws InputError: see make_laplacian
  HandleMap(const HandleDefinition& definition, const Surface& mesh, const SymmetricMatrix& stiffness,
            const HandleMapLimits& limits = {});

  Index control_count() const { return static_cast<Index>(handles_.size()); }
  Index vertex_count() const { return static_cast<Index>(partition_.place.size()); }
  const HandlePartition& partition() const { return partition_; }
  const SparseFactor& factor() const { return *factor_; }       ///< of the system of the free vertices
  const SymmetricMatrix& drive() const { return drive_; }       ///< (free, m): from displacements to right-hand sides
  bool is_truncated() const { return truncated_.has_value(); }  ///< true if M'g neglects small entries of M
  bool has_cached_columns() const { return cached_columns_.size() > 0; }  ///< of K^-1, for M'g

  Positions follow(const Controls& d) const;          ///< M d
  SparseField pull_back(const SparseField& g) const;  ///< M'g, a row for every control

  /// M'g for each covector. A contact's covector has one direction at all of its vertices. So it needs one column of a
  /// solve, and several covectors share a pass over the factor. (mathematics.md, "Laplacian editing")
  std::vector<SparseField> pull_back_all(const std::vector<SparseField>& g, const Execution& execution) const;

  /// Solves (K + pulls) u = rhs for the free vertices; u = 0 elsewhere. Reads the rows of free vertices of rhs, (n, 3).
  Positions solve(const Positions& rhs) const;

  std::vector<Index> support(Index control) const;

  /// The metric with J = M or, given S'S, (n, n), with J = S M.
  std::unique_ptr<Metric> metric(const MetricOptions& options, const WeightMatrix* surface_gram) const;

 private:
  template <class Block>
  Block product_by_solve(const Block& d) const;
  template <class Block>
  Block transposed_product_by_solve(const Block& g) const;
  template <class Block>
  void pull_by_solve(const SparseField* g, std::size_t count, SparseField* covectors) const;
  void build_full_map();
  void cache_columns(const std::vector<Index>& driven);
  Controls pull_back_cached(const SparseField& g) const;
  ColumnBlock gram_product(const ColumnBlock& d, const WeightMatrix* surface_gram) const;
  Eigen::MatrixXd gram(const WeightMatrix* surface_gram) const;
  bool product_is_cheaper() const;
  bool pulls_back_by_products() const { return is_full() || has_cached_columns() || is_truncated(); }
  bool is_full() const { return full_.rows() == vertex_count(); }

  HandleMapLimits limits_;
  HandlePartition partition_;
  std::vector<Index> handles_;
  bool hard_;
  SymmetricMatrix drive_;  ///< (free, m): from displacements of handles to right-hand sides
  std::unique_ptr<const SparseFactor> factor_;
  std::vector<unsigned char> needed_;  ///< rows of a solution that products with the transpose of `drive_` read
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> full_;  ///< M, or empty
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>
      cached_columns_;                     ///< (free, driven): columns of K^-1, or empty
  std::optional<WeightMatrix> truncated_;  ///< M without negligible entries, or nothing
  SymmetricMatrix cached_drive_;           ///< (driven, m): rows of `drive_` with entries
};

}  // namespace stiv

// How a network carries a mesh that is not its own.
#include "msm/embedding/embedding.h"

#include <gtest/gtest.h>

namespace springproof::embedding_test {
namespace {

/// Two rows of cubes, the second `gap` above the first; springs within each row only.
Network two_bars(double gap) {
  Network network;
  network.X.resize(0, 3);
  for (const double z : {0.0, 1 + gap}) {
    const Mesh bar = block_mesh({6, 1, 1}, {6, 1, 1});
    const int first = network.nodes();
    network.X.conservativeResize(first + bar.nodes.rows(), 3);
    network.X.bottomRows(bar.nodes.rows()) = bar.nodes.rowwise() + Eigen::RowVector3d(0, 0, z);
    for (int i = first; i < network.nodes(); ++i)
      for (int j = i + 1; j < network.nodes(); ++j)
        if (const double L = (network.X.row(i) - network.X.row(j)).norm(); L < 1.8)
          network.springs.push_back({i, j, 1, L});
  }
  network.volume = Eigen::VectorXd::Constant(network.nodes(), 12.0 / network.nodes());
  return network;
}

TEST(Embedding, DoesNotReachAcrossAGap) {
  const Network network = two_bars(0.2);
  const Mesh lower = block_mesh({6, 1, 1}, {12, 2, 2});
  const Embedding e = embed(lower, network, 0.1);
  NodalVectors u = NodalVectors::Zero(network.nodes(), 3);
  u.bottomRows(network.nodes() / 2).col(0).setOnes();  // the upper bar moves away
  EXPECT_LT((e.weights * u).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Embedding, CarriesAffineFieldsExactly) {
  const Network network = two_bars(0.2);
  const Mesh lower = block_mesh({6, 1, 1}, {12, 2, 2});
  const Embedding e = embed(lower, network, 0.1);
  Eigen::Matrix3d H;
  H << 0.1, -0.2, 0.3, 0.4, 0.5, -0.6, 0.7, 0.8, 0.9;
  EXPECT_LT((e.weights * (network.X * H) - lower.nodes * H).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace springproof::embedding_test

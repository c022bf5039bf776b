/// @file
/// Eigenvalues and eigenvectors of a symmetric 3 x 3 matrix, by Jacobi's rotations.
#pragma once
#include <cuda_runtime.h>

#include <cmath>
#include <glm/mat3x3.hpp>

namespace surface {

struct Eigen {
    glm::vec3 value;   ///< in no particular order
    glm::mat3 vector;  ///< column k belongs to value k; the columns are orthonormal
};

//! [jacobi]
/// Each rotation makes one off-diagonal element zero and brings the sum of their squares down; five rounds
/// over the three of them leave less than a float can show.
inline __host__ __device__ Eigen eigen_of(glm::mat3 a) {
    glm::mat3 vectors(1);
    for (int round = 0; round < 5; ++round)
        for (int k = 0; k < 3; ++k) {
            const int p = k, q = (k + 1) % 3, r = (k + 2) % 3;
            if (a[p][q] == 0) continue;
            // tan of the angle: the smaller root of t^2 + 2 t theta - 1 = 0.
            const float theta = 0.5f * (a[q][q] - a[p][p]) / a[p][q];
            const float t = std::copysign(1.0f, theta) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
            const float c = 1 / std::sqrt(t * t + 1), s = t * c;
            const float apq = a[p][q], arp = a[r][p], arq = a[r][q];
            a[p][p] -= t * apq;
            a[q][q] += t * apq;
            a[p][q] = a[q][p] = 0;
            a[r][p] = a[p][r] = c * arp - s * arq;
            a[r][q] = a[q][r] = s * arp + c * arq;
            const glm::vec3 vp = vectors[p], vq = vectors[q];
            vectors[p] = c * vp - s * vq;
            vectors[q] = s * vp + c * vq;
        }
    return {{a[0][0], a[1][1], a[2][2]}, vectors};
}
//! [jacobi]

}  // namespace surface

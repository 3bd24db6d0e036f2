"""The same full-order answer on 1, 2, 3 and 4 ranks, for each way of stepping and of solving a step."""

import numpy as np

from harness import KilnTest, datasets, main

RANKS = (2, 3, 4)


class RanksTest(KilnTest):
    def check(self, *overrides, tolerance=1e-10):
        self.solve("run", *overrides, into="ranks-1")
        alone = datasets(self.folder / "ranks-1" / "fom" / "run.h5")
        self.assertGreater(np.ptp(alone["temperature"][-1]), 100.0, "the case heats the part")
        for ranks in RANKS:
            with self.subTest(ranks=ranks):
                self.solve("run", *overrides, into=f"ranks-{ranks}", ranks=ranks)
                # All files, the checkpoint and the report's counts of iterations among them.
                compared = self.kiln("compare", "ranks-1/fom", f"ranks-{ranks}/fom", "--tolerance", tolerance)
                self.assertEqual(compared.status, 0, compared.stdout)
                other = datasets(self.folder / f"ranks-{ranks}" / "fom" / "run.h5")
                for name in ("particle", "position", "step"):
                    np.testing.assert_array_equal(other[name], alone[name], name)
                np.testing.assert_allclose(other["temperature"], alone["temperature"], rtol=tolerance, atol=0.0)

    def test_backward_euler_with_diagonal_jacobian(self):
        self.check()

    def test_trapezoidal_with_sparse_jacobian_and_gmres(self):
        self.check("time.scheme=trapezoidal", "time.newton.jacobian=sparse", "time.newton.linear_solver.type=gmres")

    def test_rk4(self):
        self.check("time.scheme=rk4")

    def test_matrix_free_jacobian_with_bicgstab(self):
        self.check(
            "time.newton.jacobian=matrix free",
            "time.newton.linear_solver.type=bicgstab",
            "time.newton.linear_solver.preconditioner=jacobi",
        )

    def test_bdf2_with_finite_difference_jacobian(self):
        # A difference quotient carries the rate's round-off divided by its step, about 1e-8 relative; what Newton's
        # iteration makes of it stays within its own tolerance of 1e-6 of the rise of one step, about 1e-8 of 293 K.
        self.check("time.scheme=bdf2", "time.newton.jacobian=finite difference", tolerance=1e-8)


if __name__ == "__main__":
    main()

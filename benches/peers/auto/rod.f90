! A rod with a constant force N and constant C = M + r x N in the fixed basis: states (r, q), wrench (N, C).
! r' = (1 + eps) d3(q),  q' = q (0, K)/2,  scalar first; strains (eps, K) by a law from (d3.N, d_i.M).
module rod
  implicit none
  private
  public :: field, law

  integer, parameter :: dp = kind(1d0)

  abstract interface
    ! Strains of (n3, m1, m2, m3) and their derivatives.
    subroutine law(wrench, strain, compliance)
      double precision, intent(in) :: wrench(4)
      double precision, intent(out) :: strain(4), compliance(4, 4)
    end subroutine
  end interface

contains

  pure function cross(a, b)
    real(dp), intent(in) :: a(3), b(3)
    real(dp) :: cross(3)
    cross = [a(2)*b(3) - a(3)*b(2), a(3)*b(1) - a(1)*b(3), a(1)*b(2) - a(2)*b(1)]
  end function

  ! Directors, row by row, of a quaternion, and their derivatives with its components.
  pure subroutine directors(q, d, dq)
    real(dp), intent(in) :: q(4)
    real(dp), intent(out) :: d(3, 3), dq(3, 3, 4)
    real(dp) :: w, x, y, z
    w = q(1); x = q(2); y = q(3); z = q(4)
    d(1, :) = [w*w + x*x - y*y - z*z, 2*(x*y + w*z), 2*(x*z - w*y)]
    d(2, :) = [2*(x*y - w*z), w*w - x*x + y*y - z*z, 2*(y*z + w*x)]
    d(3, :) = [2*(x*z + w*y), 2*(y*z - w*x), w*w - x*x - y*y + z*z]
    dq(1, :, 1) = 2*[w, z, -y]; dq(1, :, 2) = 2*[x, y, z]; dq(1, :, 3) = 2*[-y, x, -w]; dq(1, :, 4) = 2*[-z, w, x]
    dq(2, :, 1) = 2*[-z, w, x]; dq(2, :, 2) = 2*[y, -x, w]; dq(2, :, 3) = 2*[x, y, z]; dq(2, :, 4) = 2*[-w, -z, y]
    dq(3, :, 1) = 2*[y, -x, w]; dq(3, :, 2) = 2*[z, -w, -x]; dq(3, :, 3) = 2*[w, z, -y]; dq(3, :, 4) = 2*[x, y, z]
  end subroutine

  ! u' of u = (r, q) and, if wanted, its derivatives with u (7, 7) and with (N, C) (7, 6).
  subroutine field(u, n, c, strains, wanted, f, du, dw)
    real(dp), intent(in) :: u(7), n(3), c(3)
    procedure(law) :: strains
    logical, intent(in) :: wanted
    real(dp), intent(out) :: f(7)
    real(dp), intent(inout) :: du(7, 7), dw(7, 6)
    real(dp) :: d(3, 3), dq(3, 3, 4), m(3), e(4), s(4, 4), turn(4, 3), by_u(4, 7), by_w(4, 6)
    integer :: i, k
    call directors(u(4:7), d, dq)
    m = c - cross(u(1:3), n)
    call strains([dot_product(d(3, :), n), matmul(d, m)], e, s)
    f(1:3) = (1 + e(1))*d(3, :)
    ! Columns: q (0, i)/2, q (0, j)/2, q (0, k)/2.
    turn(:, 1) = [-u(5), u(4), u(7), -u(6)]/2
    turn(:, 2) = [-u(6), -u(7), u(4), u(5)]/2
    turn(:, 3) = [-u(7), u(6), -u(5), u(4)]/2
    f(4:7) = matmul(turn, e(2:4))
    if (.not. wanted) return

    ! Of (n3, m) on the directors.
    by_u = 0; by_w = 0
    do i = 1, 3
      by_u(1 + i, 1:3) = cross(d(i, :), n)           ! d_i . (-dr x N) = dr . (d_i x N)
      by_w(1 + i, 1:3) = -cross(d(i, :), u(1:3))     ! d_i . (-r x dN) = -dN . (d_i x r)
      by_w(1 + i, 4:6) = d(i, :)
    end do
    by_w(1, 1:3) = d(3, :)
    do k = 1, 4
      by_u(1, 3 + k) = dot_product(dq(3, :, k), n)
      by_u(2:4, 3 + k) = matmul(dq(:, :, k), m)
    end do
    by_u = matmul(s, by_u); by_w = matmul(s, by_w)

    do k = 1, 7
      du(1:3, k) = d(3, :)*by_u(1, k)
      du(4:7, k) = matmul(turn, by_u(2:4, k))
    end do
    do k = 1, 6
      dw(1:3, k) = d(3, :)*by_w(1, k)
      dw(4:7, k) = matmul(turn, by_w(2:4, k))
    end do
    do k = 1, 4
      du(1:3, 3 + k) = du(1:3, 3 + k) + (1 + e(1))*dq(3, :, k)
    end do
    du(4, 5:7) = du(4, 5:7) - e(2:4)/2
    du(5:7, 4) = du(5:7, 4) + e(2:4)/2
    du(5, 6) = du(5, 6) + e(4)/2; du(5, 7) = du(5, 7) - e(3)/2
    du(6, 5) = du(6, 5) - e(4)/2; du(6, 7) = du(6, 7) + e(2)/2
    du(7, 5) = du(7, 5) + e(3)/2; du(7, 6) = du(7, 6) - e(2)/2
  end subroutine
end module

! The relaxed section of a ribbon whose edges grow, in the scaling that leaves no thickness ratio:
! e = eps/eta^2, k1 = K1/eta^2, k = K/eta (2 and 3), x = xi/eta^2, energy Pi/eta^4, Liu, Li & Liu, eqs. (57), (58):
!
!   Pi/eta^4 = g^2/2 + k1^2/24 + k2^2/24 + k3^2/18 + sigma(y) a^2/32,   y = 9 k2^2/4,
!   g = e + k3^2/24 - x/3,   a = k2^2 + 2 k3^2 - 16 x,   sigma = (1 - tau)/y.
!
! sigma is the quotient of two entire series in y without a negative term, so nothing cancels.
module edge_law
  implicit none
  private
  public :: section, inverse

  integer, parameter :: dp = kind(1d0), terms = 11   ! rounding for y < 200, |k2| < 9
  real(dp) :: p(0:terms) = 0, q(0:terms) = 0
  logical :: ready = .false.

contains

  subroutine prepare()
    real(dp) :: factorial
    integer :: k
    do k = 0, terms
      factorial = gamma(4*k + 2d0)                   ! (4 k + 1)!
      q(k) = 1/factorial
      p(k) = 4*(k + 1)/gamma(4*k + 7d0)              ! 4 (k + 1) / (4 k + 6)!
    end do
    ready = .true.
  end subroutine

  ! sigma and its first two derivatives with respect to y.
  pure subroutine sigma(y, s, s1, s2)
    real(dp), intent(in) :: y
    real(dp), intent(out) :: s, s1, s2
    real(dp) :: u, u1, u2, v, v1, v2
    integer :: k
    u = p(terms); u1 = 0; u2 = 0
    v = q(terms); v1 = 0; v2 = 0
    do k = terms - 1, 0, -1
      u2 = u2*y + 2*u1; u1 = u1*y + u; u = u*y + p(k)
      v2 = v2*y + 2*v1; v1 = v1*y + v; v = v*y + q(k)
    end do
    s = u/v
    s1 = (u1 - s*v1)/v
    s2 = (u2 - 2*s1*v1 - s*v2)/v
  end subroutine

  ! Of the energy of relaxation and bending, k2^2/24 + sigma a^2/32: first and second derivatives.
  pure subroutine relaxed(k2, k3, x, f2, f3, f22, f23, f33, f2x, f3x)
    real(dp), intent(in) :: k2, k3, x
    real(dp), intent(out) :: f2, f3, f22, f23, f33, f2x, f3x
    real(dp) :: s, s1, s2, d, d2, a
    call sigma(2.25d0*k2**2, s, s1, s2)
    d = 4.5d0*k2*s1
    d2 = 20.25d0*k2**2*s2 + 4.5d0*s1
    a = k2**2 + 2*k3**2 - 16*x
    f2 = k2/12 + (d*a + 4*s*k2)*a/32
    f3 = s*a*k3/4
    f22 = 1/12d0 + (d2*a**2 + 8*d*a*k2 + 8*s*k2**2 + 4*s*a)/32
    f23 = (d*a + 2*s*k2)*k3/4
    f33 = s*(a + 4*k3**2)/4
    f2x = -(d*a + 2*s*k2)
    f3x = -4*s*k3
  end subroutine

  ! Force and moments (n3, m1, m2, m3) of strains (e, k1, k2, k3), their derivatives h, and those with x.
  subroutine section(strain, x, wrench, h, hx)
    real(dp), intent(in) :: strain(4), x
    real(dp), intent(out) :: wrench(4), h(4, 4), hx(4)
    real(dp) :: g, f2, f3, f22, f23, f33, f2x, f3x
    if (.not. ready) call prepare()
    call relaxed(strain(3), strain(4), x, f2, f3, f22, f23, f33, f2x, f3x)
    g = strain(1) + strain(4)**2/24 - x/3
    wrench = [g, strain(2)/12, f2, strain(4)*(1/9d0 + g/12) + f3]
    h = 0
    h(1, 1) = 1
    h(1, 4) = strain(4)/12; h(4, 1) = h(1, 4)
    h(2, 2) = 1/12d0
    h(3, 3) = f22
    h(3, 4) = f23; h(4, 3) = f23
    h(4, 4) = 1/9d0 + g/12 + strain(4)**2/144 + f33
    hx = [-1/3d0, 0d0, f2x, f3x - strain(4)/36]
  end subroutine

  ! Strains of a wrench, and their derivatives c, by Newton's method in (k2, k3) from what they are.
  subroutine inverse(wrench, x, strain, c)
    real(dp), intent(in) :: wrench(4), x
    real(dp), intent(inout) :: strain(4)
    real(dp), intent(out) :: c(4, 4)
    real(dp) :: k2, k3, f2, f3, f22, f23, f33, f2x, f3x, r2, r3, determinant, step2, step3, twist
    integer :: iteration
    if (.not. ready) call prepare()
    k2 = strain(3); k3 = strain(4)
    twist = 1/9d0 + wrench(1)/12
    do iteration = 1, 30
      call relaxed(k2, k3, x, f2, f3, f22, f23, f33, f2x, f3x)
      r2 = f2 - wrench(3)
      r3 = f3 + twist*k3 - wrench(4)
      f33 = f33 + twist
      determinant = f22*f33 - f23**2
      step2 = (f33*r2 - f23*r3)/determinant
      step3 = (f22*r3 - f23*r2)/determinant
      k2 = k2 - step2
      k3 = k3 - step3
      ! The step after this one would be its square: the derivatives are as good as the strains then.
      if (abs(step2) + abs(step3) < 1d-8) exit
    end do
    strain = [wrench(1) - k3**2/24 + x/3, 12*wrench(2), k2, k3]
    c = 0
    c(2, 2) = 12
    c(3, 3) = f33/determinant
    c(4, 4) = f22/determinant
    c(3, 4) = -f23/determinant; c(4, 3) = c(3, 4)
    ! k2 and k3 depend on n3 through the twisting stiffness.
    c(3:4, 1) = -c(3:4, 4)*k3/12
    c(1, 3:4) = -k3/12*c(4, 3:4)
    c(1, 1) = 1 - k3/12*c(4, 1)
  end subroutine
end module

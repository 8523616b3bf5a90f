! S1, growing edges, clamped and free: states e, k1, k2, k3 in the units of edge_law, shear forces n1, n2 over eta^3/L, r/L, q.
! The strains are states since their law has no inverse where the section bifurcates: h e' = (n3, m1, m2, m3)' - what shear forces
! and curvatures make of the balance. par: x = xi/eta^2.
subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
  use edge_law, only: section
  implicit none
  integer, intent(in) :: ndim, ijac, icp(*)
  double precision, intent(in) :: u(ndim), par(*)
  double precision, intent(out) :: f(ndim)
  double precision, intent(inout) :: dfdu(ndim, ndim), dfdp(ndim, *)
  double precision, parameter :: eta = 0.1d0, length = 10
  ! Strains and wrench in units of 1, 1/L and of eta^3/L, eta^3 from those of edge_law.
  double precision, parameter :: unit(4) = [eta**2, eta**2*length, eta*length, eta*length]
  double precision, parameter :: load(4) = [length/eta, 1/eta, 1d0, 1d0]
  double precision :: w(4), h(4, 4), hx(4), s(4), n(3), m(3), k(3), g(4), a(4, 4), gu(4, 6), turn(4, 3), d3(3), factor(4, 4), stretch
  integer :: i, j
  call section(u(1:4), par(1), w, h, hx)
  w = load*w
  s = unit*u(1:4)
  stretch = 1 + s(1)
  k = s(2:4)
  n = [u(5), u(6), w(1)]
  m = w(2:4)
  ! (n3, m)' and (n1, n2)'
  g(1) = k(2)*n(1) - k(1)*n(2)
  g(2) = k(3)*m(2) - k(2)*m(3) + stretch*n(2)
  g(3) = k(1)*m(3) - k(3)*m(1) - stretch*n(1)
  g(4) = k(2)*m(1) - k(1)*m(2)
  f(5) = k(3)*n(2) - k(2)*n(3)
  f(6) = k(1)*n(3) - k(3)*n(1)
  factor = inverse4(h)
  f(1:4) = matmul(factor, g/load)
  associate (q => u(10:13))
    d3 = [2*(q(2)*q(4) + q(1)*q(3)), 2*(q(3)*q(4) - q(1)*q(2)), q(1)**2 - q(2)**2 - q(3)**2 + q(4)**2]
    turn(:, 1) = [-q(2), q(1), q(4), -q(3)]/2
    turn(:, 2) = [-q(3), -q(4), q(1), q(2)]/2
    turn(:, 3) = [-q(4), q(3), -q(2), q(1)]/2
  end associate
  f(7:9) = stretch*d3
  f(10:13) = matmul(turn, k)
  if (ijac == 0) return

  ! Derivatives of the right side with (e, k1, k2, k3) at given wrench, then through the wrench, then with n1, n2. Those of h are
  ! left out: they multiply e', which is zero at every solution of this scene.
  gu = 0
  gu(1, 2:3) = [-n(2), n(1)]
  gu(2, 1:4) = [n(2), 0d0, -m(3), m(2)]
  gu(3, 1:4) = [-n(1), m(3), 0d0, -m(1)]
  gu(4, 2:3) = [-m(2), m(1)]
  a = 0                                                  ! with the wrench (n3, m)
  a(2, 3:4) = [k(3), -k(2)]
  a(3, 2:4) = [-k(3), 0d0, k(1)]
  a(4, 2:3) = [k(2), -k(1)]
  do j = 1, 4
    gu(:, j) = gu(:, j)*unit(j) + matmul(a, load*h(:, j))
  end do
  gu(:, 5) = [k(2), 0d0, -stretch, 0d0]
  gu(:, 6) = [-k(1), stretch, 0d0, 0d0]
  dfdu = 0
  do j = 1, 6
    dfdu(1:4, j) = matmul(factor, gu(:, j)/load)
  end do
  dfdp(:, 1) = 0
  dfdp(1:4, 1) = matmul(factor, matmul(a, load*hx)/load)
  do j = 1, 4
    dfdu(5:6, j) = [-k(2), k(1)]*load(1)*h(1, j)
  end do
  dfdu(5, 3) = dfdu(5, 3) - n(3)*unit(3); dfdu(5, 4) = dfdu(5, 4) + n(2)*unit(4)
  dfdu(6, 2) = dfdu(6, 2) + n(3)*unit(2); dfdu(6, 4) = dfdu(6, 4) - n(1)*unit(4)
  dfdu(5, 6) = k(3)
  dfdu(6, 5) = -k(3)
  dfdp(5:6, 1) = [-k(2), k(1)]*load(1)*hx(1)
  dfdu(7:9, 1) = unit(1)*d3
  associate (q => u(10:13))
    dfdu(7:9, 10) = 2*stretch*[q(3), -q(2), q(1)]
    dfdu(7:9, 11) = 2*stretch*[q(4), -q(1), -q(2)]
    dfdu(7:9, 12) = 2*stretch*[q(1), q(4), -q(3)]
    dfdu(7:9, 13) = 2*stretch*[q(2), q(3), q(4)]
  end associate
  do i = 1, 3
    dfdu(10:13, 1 + i) = turn(:, i)*unit(1 + i)
  end do
  dfdu(10, 11:13) = -k/2
  dfdu(11, 10:13) = [k(1), 0d0, k(3), -k(2)]/2
  dfdu(12, 10:13) = [k(2), -k(3), 0d0, k(1)]/2
  dfdu(13, 10:13) = [k(3), k(2), -k(1), 0d0]/2

contains

  ! Of a stiffness of the section: rows and columns 1, 3, 4, and 2 by itself.
  pure function inverse4(h) result(c)
    double precision, intent(in) :: h(4, 4)
    double precision :: c(4, 4), h44, determinant
    h44 = h(4, 4) - h(4, 1)**2/h(1, 1)
    determinant = h(3, 3)*h44 - h(3, 4)**2
    c = 0
    c(2, 2) = 1/h(2, 2)
    c(3, 3) = h44/determinant
    c(4, 4) = h(3, 3)/determinant
    c(3, 4) = -h(3, 4)/determinant; c(4, 3) = c(3, 4)
    c(1, 3:4) = -h(1, 4)/h(1, 1)*c(4, 3:4)
    c(3:4, 1) = c(1, 3:4)
    c(1, 1) = 1/h(1, 1) - h(1, 4)/h(1, 1)*c(4, 1)
  end function
end subroutine

! Flat and ungrown.
subroutine stpnt(ndim, u, par, t)
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(inout) :: u(ndim), par(*)
  double precision, intent(in) :: t
  par(1) = 0
  u = 0
  u(9:10) = [t, 1d0]
end subroutine

subroutine bcnd(ndim, par, icp, nbc, u0, u1, fb, ijac, dbc)
  use edge_law, only: section
  implicit none
  integer, intent(in) :: ndim, icp(*), nbc, ijac
  double precision, intent(in) :: par(*), u0(ndim), u1(ndim)
  double precision, intent(out) :: fb(nbc)
  double precision, intent(inout) :: dbc(nbc, *)
  double precision :: w(4), h(4, 4), hx(4)
  integer :: i
  call section(u1(1:4), par(1), w, h, hx)
  fb(1:7) = u0(7:13) - [0, 0, 0, 1, 0, 0, 0]
  fb(8:9) = u1(5:6)
  fb(10:13) = w
  if (ijac == 0) return
  dbc(:, 1:2*ndim + 1) = 0
  do i = 1, 7
    dbc(i, 6 + i) = 1
  end do
  dbc(8, ndim + 5) = 1
  dbc(9, ndim + 6) = 1
  dbc(10:13, ndim + 1:ndim + 4) = h
  dbc(10:13, 2*ndim + 1) = hx
end subroutine

subroutine pvls(ndim, u, par)
  use record, only: write_point
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(in) :: u(ndim, 0:*), par(*)
  call write_point(ndim, u, par, 1)
end subroutine

subroutine icnd
end subroutine

subroutine fopt
end subroutine

!> Error of a computed field: the recovered one less the computed one, element by element.
!>
!> The computed field of an element is the tensor-product polynomial through its own 2 x 2 or 3 x 3 points: bilinear or biquadratic.
!> For 2 x 2 points this is the stress of the mixed element that the one with reduced integration is equal to; its stress at the
!> points alone is better than that, and an error taken there would be zero. Norms are integrals over 3 x 3 points. What the
!> polynomials miss of the values they are fitted to counts as error: near singularities and in plastic flow it is most of it.
!> Sources: D.S. Malkus, T.J.R. Hughes, Comput. Meth. Appl. Mech. Engng 15 (1978) 63-81 (equivalence); O.C. Zienkiewicz, J.Z. Zhu,
!> Int. J. Num. Meth. Engng 24 (1987) 337-357 (error by recovery, energy norm).
module recovered_errors
  use kinds, only: wp
  use patch_recovery, only: fit_patches, ncomp => nvalue, polynomials_t, recover
  use plane_vectors, only: cross
  use quad8_geometry, only: quad8_rule, quad8_rule_t
  use quadrature, only: square_rule
  use sections, only: thickness_at
  use shape_functions, only: quad4
  use vertex_patches, only: patches_t
  implicit none
  private
  public :: fields_t, fields_of_rule, missing_squares, ncomp, npoint

  !> Integration points of the norms, and those of the patches. The ncomp components are stress xx, yy, xy, zz, then the strain
  !> increment in the same order.
  integer, parameter :: npoint = 9, nsample = 4

  !> How values at the points of an element become those at 2 x 2 and at 3 x 3 points, and the rules of all three.
  type :: fields_t
    type(quad8_rule_t) :: own, samples, points
    real(wp), allocatable :: to_samples(:, :), to_points(:, :)   !! (own, 4), (own, 9)
    real(wp) :: blend(4, npoint) = 0.0_wp
  end type fields_t

contains

  !> For elements of 4 or 9 points. The best bilinear fit to a biquadratic equals it at the 2 x 2 points, where Legendre's second
  !> polynomial is zero.
  pure function fields_of_rule(nown) result(fields)
    integer, intent(in) :: nown
    type(fields_t) :: fields
    real(wp), allocatable :: own(:, :), points(:, :), samples(:, :), weight(:), unused(:)
    integer :: p, q

    call quad8_rule(nown, fields%own)
    call quad8_rule(nsample, fields%samples)
    call quad8_rule(npoint, fields%points)
    call square_rule(nown, own, weight)
    call square_rule(nsample, samples, unused)
    call square_rule(npoint, points, unused)
    allocate (fields%to_samples(nown, nsample), fields%to_points(nown, npoint), source=0.0_wp)
    do q = 1, nsample
      fields%to_samples(:, q) = bilinear_fit(own, weight, samples(:, q))
    end do
    do q = 1, npoint
      call quad4(points(1, q), points(2, q), fields%blend(:, q))
      fields%to_points(:, q) = bilinear_fit(own, weight, points(:, q))
    end do
    if (nown == nsample) then
      fields%to_samples = 0
      do p = 1, nsample
        fields%to_samples(p, p) = 1
      end do
    else
      fields%to_points = 0
      do p = 1, npoint
        fields%to_points(p, p) = 1
      end do
    end if
  end function fields_of_rule

  !> Weights of the values at points for the best bilinear fit at a point; 1, xi, eta, xi eta are orthogonal under the rule.
  pure function bilinear_fit(xi, weight, place) result(share)
    real(wp), intent(in) :: xi(:, :), weight(:), place(2)
    real(wp) :: share(size(weight))

    share = weight*(1/sum(weight) + place(1)*xi(1, :)/sum(weight*xi(1, :)**2) + place(2)*xi(2, :)/sum(weight*xi(2, :)**2) &
                    + place(1)*place(2)*xi(1, :)*xi(2, :)/sum(weight*(xi(1, :)*xi(2, :))**2))
  end function bilinear_fit

  !> Squares of stress (energy norm: deviator and pressure have their own weights) and of the strain increment (its deviator),
  !> integrated over each element.
  pure subroutine missing_squares(patches, fields, rule_of, section, coordinates, connectivity, value, weights, &
                                  missing, whole, volume)
    type(patches_t), intent(in) :: patches
    type(fields_t), intent(in) :: fields(:)                 !! (nrule) of all rules
    integer, intent(in) :: rule_of(:)                       !! (nelem) of each element, position in `fields`
    real(wp), intent(in) :: section(3)                      !! thickness (sections) [length] and its slopes [-]
    real(wp), intent(in), contiguous :: coordinates(:, :)   !! (2, nnode) [length]
    integer, intent(in) :: connectivity(:, :)               !! (8, nelem)
    real(wp), intent(in), contiguous :: value(:, :, :)      !! (ncomp, 9, nelem) at own points, up to 9 [unit of each component]
    real(wp), intent(in) :: weights(:, :)                   !! (2, nelem) of the square of deviator and of pressure [1/stress]
    real(wp), intent(out) :: missing(:, :), whole(:, :)     !! (2, nelem) stress [energy], strain [volume]
    real(wp), intent(out) :: volume(:)                      !! (nelem) [volume]
    type(polynomials_t) :: polynomials
    real(wp) :: place(2, nsample, size(connectivity, 2)), at_samples(ncomp, nsample, size(connectivity, 2))
    real(wp) :: x(2, 8), here(2, npoint), own(ncomp, npoint), better(ncomp, npoint), a(2), b(2), dv
    integer :: e, q, n

    do e = 1, size(connectivity, 2)
      associate (f => fields(rule_of(e)))
        n = f%own%npoint
        x = coordinates(:, connectivity(:, e))
        do q = 1, nsample
          place(:, q, e) = [dot_product(x(1, :), f%samples%phi(:, q)), dot_product(x(2, :), f%samples%phi(:, q))]
        end do
        call carry(value(:, :n, e), f%to_samples, at_samples(:, :, e))
      end associate
    end do
    call fit_patches(patches, coordinates, place, at_samples, polynomials)
    missing = 0
    whole = 0
    volume = 0
    do e = 1, size(connectivity, 2)
      x = coordinates(:, connectivity(:, e))
      associate (f => fields(rule_of(e)))
        call carry(value(:, :f%own%npoint, e), f%to_points, own)
        do q = 1, npoint
          here(:, q) = [dot_product(x(1, :), f%points%phi(:, q)), dot_product(x(2, :), f%points%phi(:, q))]
        end do
        call recover(patches, polynomials, e, here, f%blend, better)
        do q = 1, npoint
          a = [dot_product(x(1, :), f%points%dphi(1, :, q)), dot_product(x(2, :), f%points%dphi(1, :, q))]
          b = [dot_product(x(1, :), f%points%dphi(2, :, q)), dot_product(x(2, :), f%points%dphi(2, :, q))]
          ! a worn element may have turned over beyond its own points: a measure of squares is positive there too
          dv = abs(cross(a, b))*f%points%weight(q)*thickness_at(section, here(:, q))
          missing(:, e) = missing(:, e) + dv*squares(better(:, q) - own(:, q), weights(:, e))
          whole(:, e) = whole(:, e) + dv*squares(better(:, q), weights(:, e))
          volume(e) = volume(e) + dv
        end do
      end associate
    end do
  end subroutine missing_squares

  !> Values at points from those at others.
  pure subroutine carry(from, weights, to)
    real(wp), intent(in), contiguous :: from(:, :), weights(:, :)   !! (ncomp, nfrom), (nfrom, nto)
    real(wp), intent(out) :: to(ncomp, size(weights, 2))
    integer :: p, q

    to = 0
    do q = 1, size(weights, 2)
      do p = 1, size(weights, 1)
        to(:, q) = to(:, q) + weights(p, q)*from(:ncomp, p)
      end do
    end do
  end subroutine carry

  !> Energy density of a stress, s:s and p^2 by their weights, and e:e of the deviator of a strain.
  pure function squares(value, weights) result(square)
    real(wp), intent(in) :: value(ncomp), weights(2)
    real(wp) :: square(2)
    real(wp) :: mean

    mean = (value(1) + value(2) + value(4))/3
    square(1) = weights(1)*((value(1) - mean)**2 + (value(2) - mean)**2 + (value(4) - mean)**2 + 2*value(3)**2) &
                + weights(2)*mean**2
    mean = (value(5) + value(6) + value(8))/3
    square(2) = (value(5) - mean)**2 + (value(6) - mean)**2 + (value(8) - mean)**2 + 2*value(7)**2
  end function squares

end module recovered_errors

!> One point under a history of motions, for the tests of kinematics.
module motion_cases
  use kinds, only: pi, wp
  use kinematics_api, only: first_history, kinematics_t
  use kinematics_registry, only: list_kinematics
  use law_api, only: law_t
  use law_cases, only: elastic_material, law_row, plastic_material
  use materials, only: material_t
  use sample_numbers, only: sample_t
  implicit none
  private
  public :: nstate, body_t, new_body, move, turned, times, rotation, random_motion, identity, differences_of
  public :: full_turn, closed_cycle

  !> Stress, elastic strain, and a history of two (ELA carries it along).
  integer, parameter :: nstate = first_history + 1

  !> No motion, in the components xx, xy, yx, yy, zz of `f`.
  real(wp), parameter :: identity(5) = [1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, 1.0_wp]

  !> A point of a body: its law, material, kinematics and committed state.
  type :: body_t
    type(law_t) :: law
    type(material_t) :: material
    type(kinematics_t) :: kinematics
    real(wp) :: state(nstate) = 0.0_wp
  end type body_t

contains

  !> A virgin point; `hardening` as in `plastic_material`, 0 for ELA.
  function new_body(kinematics, hardening) result(body)
    character(len=*), intent(in) :: kinematics
    integer, intent(in) :: hardening
    type(body_t) :: body
    type(kinematics_t), allocatable :: rows(:)
    integer :: i

    call list_kinematics(rows)
    do i = 1, size(rows)
      if (rows(i)%name == kinematics) body%kinematics = rows(i)
    end do
    if (hardening == 0) then
      body%law = law_row('ELA')
      body%material = elastic_material()
    else
      body%law = law_row('EPLA')
      body%material = plastic_material(hardening)
    end if
  end function new_body

  !> Answer to the motion f of a step; the body itself stays as it is.
  subroutine move(body, f, state, tangent, status)
    type(body_t), intent(in) :: body
    real(wp), intent(in) :: f(5)
    real(wp), intent(out) :: state(nstate), tangent(4, 5)
    integer, intent(out) :: status
    real(wp) :: drivers(1, 2, 1), block_f(5, 1), committed(nstate, 1), trial(nstate, 1), block_tangent(4, 5, 1)
    integer :: block_status(1)

    block_f(:, 1) = f
    committed(:, 1) = body%state
    drivers = 0
    call body%kinematics%update(body%law, body%material, 1.0_wp, 1, nstate, drivers, block_f, committed, trial, block_tangent, &
                                block_status)
    state = trial(:, 1)
    tangent = block_tangent(:, :, 1)
    status = block_status(1)
  end subroutine move

  !> d stress / d h by central differences of the whole update, h = d(du)/dx(n+1): f becomes (1 + h) f,
  !> or 1 + (f - 1) + h where the geometry does not follow.
  subroutine differences_of(body, f, step, tangent)
    type(body_t), intent(in) :: body
    real(wp), intent(in) :: f(5), step
    real(wp), intent(out) :: tangent(4, 5)
    real(wp), dimension(nstate) :: plus, minus
    real(wp) :: h(5), scratch(4, 5)
    integer :: j, status

    do j = 1, 5
      h = 0
      h(j) = step
      if (body%kinematics%finite) then
        call move(body, times(identity + h, f), plus, scratch, status)
        call move(body, times(identity - h, f), minus, scratch, status)
      else
        call move(body, f + h, plus, scratch, status)
        call move(body, f - h, minus, scratch, status)
      end if
      tangent(:, j) = (plus(1:4) - minus(1:4))/(2*step)
    end do
  end subroutine differences_of

  !> Product of two motions, a after b.
  pure function times(a, b) result(c)
    real(wp), intent(in) :: a(5), b(5)
    real(wp) :: c(5)

    c = [a(1)*b(1) + a(2)*b(3), a(1)*b(2) + a(2)*b(4), a(3)*b(1) + a(4)*b(3), a(3)*b(2) + a(4)*b(4), a(5)*b(5)]
  end function times

  !> Rotation in the plane.
  pure function rotation(angle) result(f)
    real(wp), intent(in) :: angle
    real(wp) :: f(5)

    f = [cos(angle), -sin(angle), sin(angle), cos(angle), 1.0_wp]
  end function rotation

  !> A tensor (xx, yy, xy, zz) turned by an angle.
  pure function turned(s, angle) result(t)
    real(wp), intent(in) :: s(4), angle
    real(wp) :: t(4)
    real(wp) :: q(2, 2), m(2, 2)

    q = reshape([cos(angle), sin(angle), -sin(angle), cos(angle)], [2, 2])
    m = matmul(q, matmul(reshape([s(1), s(3), s(3), s(2)], [2, 2]), transpose(q)))
    t = [m(1, 1), m(2, 2), m(1, 2), s(4)]
  end function turned

  !> A motion with gradients up to `size_of_motion`, then a turn by up to `turn`.
  subroutine random_motion(sample, size_of_motion, turn, f)
    type(sample_t), intent(inout) :: sample
    real(wp), intent(in) :: size_of_motion, turn
    real(wp), intent(out) :: f(5)
    real(wp) :: angle

    call sample%fill(-size_of_motion, size_of_motion, f)
    call sample%draw(-turn, turn, angle)
    f = times(rotation(angle), identity + f)
  end subroutine random_motion

  !> A stressed point makes a full turn in n steps: largest change of stress, elastic strain or history over its size.
  subroutine full_turn(kinematics, hardening, n, drift)
    character(len=*), intent(in) :: kinematics
    integer, intent(in) :: hardening, n
    real(wp), intent(out) :: drift
    type(body_t) :: body
    real(wp) :: start(nstate), state(nstate), tangent(4, 5)
    integer :: i, status

    body = new_body(kinematics, hardening)
    call move(body, [1.05_wp, 0.04_wp, -0.02_wp, 0.93_wp, 1.03_wp], start, tangent, status)
    body%state = start
    do i = 1, n
      call move(body, rotation(2*pi/n), state, tangent, status)
      body%state = state
    end do
    drift = max(norm2(state(1:4) - start(1:4))/norm2(start(1:4)), norm2(state(5:8) - start(5:8))/norm2(start(5:8)), &
                norm2(state(9:) - start(9:))/max(norm2(start(9:)), norm2(start(5:8))))
  end subroutine full_turn

  !> An elastic point is sheared by gamma, stretched to 1 + gamma, sheared back and pressed back, each in n steps: stress left.
  subroutine closed_cycle(kinematics, gamma, n, left)
    character(len=*), intent(in) :: kinematics
    real(wp), intent(in) :: gamma
    integer, intent(in) :: n
    real(wp), intent(out) :: left(4)
    type(body_t) :: body
    real(wp) :: state(nstate), tangent(4, 5), motions(5, 4), stretch
    integer :: leg, i, status

    body = new_body(kinematics, 0)
    stretch = (1 + gamma)**(1.0_wp/n)
    motions(:, 1) = [1.0_wp, gamma/n, 0.0_wp, 1.0_wp, 1.0_wp]
    motions(:, 2) = [1.0_wp, 0.0_wp, 0.0_wp, stretch, 1.0_wp]
    ! the same shear of the material, on a body stretched along y
    motions(:, 3) = [1.0_wp, -gamma/(1 + gamma)/n, 0.0_wp, 1.0_wp, 1.0_wp]
    motions(:, 4) = [1.0_wp, 0.0_wp, 0.0_wp, 1/stretch, 1.0_wp]
    do leg = 1, 4
      do i = 1, n
        call move(body, motions(:, leg), state, tangent, status)
        body%state = state
      end do
    end do
    left = body%state(1:4)
  end subroutine closed_cycle

end module motion_cases

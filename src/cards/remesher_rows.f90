!> Rows of REMSH on how the new mesh is made.
module remesher_rows
  use acceptance, only: acceptance_t
  use deck_cursor, only: cursor_t
  use kinds, only: pi, wp
  use remeshing, only: never, remesh_rules_t
  use remesher_options, only: by_free, by_gmsh, has_contours, has_zones, remesher_options_t
  use scene_draft, only: words_of
  use text, only: string_t
  implicit none
  private
  public :: remesher_words, read_remesher_row, make_sizes_finer

  !> In the order of `read_remesher_row`.
  character(len=*), parameter :: remesher_words = 'STRAIN SIZE COUNT ACROSS TURN STRETCH TRANSFER ACCEPT TRIES MESHER'
  !> Meshers by their numbers, from 1.
  character(len=*), parameter :: meshers = 'ZONES GMSH FREE'
  !> Methods of transfer by their numbers, from 0.
  character(len=*), parameter :: methods = 'DIST MLS PATCH'
  !> Limits of ACCEPT.
  character(len=*), parameter :: limits = 'RESIDUAL ITERATIONS FORCE ENERGY DEPTH STEP'
  !> Moving squares of degree 2 need 6 points, and some more not to be an interpolation.
  integer, parameter :: fewest_neighbours = 8, most_neighbours = 64
  !> Longer elements than this are past the limit of `ASPECT` soon (remesh_defaults).
  real(wp), parameter :: largest_stretch = 5.0_wp

contains

  subroutine read_remesher_row(cursor, word, options)
    type(cursor_t), intent(inout) :: cursor
    character(len=*), intent(in) :: word
    type(remesher_options_t), intent(inout) :: options
    type(string_t), allocatable :: words(:)
    real(wp) :: degrees

    select case (word)
    case ('STRAIN')
      call cursor%real('the error of the strain an element is made for', options%strain_error, lower=0.0_wp, strict_lower=.true.)
    case ('SIZE')
      call cursor%real('the smallest size of an element', options%smallest, lower=0.0_wp, strict_lower=.true., unit='length')
      call cursor%real('the largest size of an element', options%largest, lower=options%smallest, unit='length')
    case ('COUNT')
      call cursor%integer('the largest number of elements', options%most_elements, lower=1)
    case ('ACROSS')
      call cursor%integer('the number of elements across a contact interval', options%across_contact, lower=0, upper=1000)
    case ('TURN')
      call cursor%real('the angle a side of an element may turn by', degrees, lower=0.0_wp, upper=90.0_wp, &
                       strict_lower=.true., unit='degrees')
      options%turn = degrees*pi/180
      options%turn_at_dies = options%turn
    case ('STRETCH')
      call cursor%real('the largest ratio of length to width of an element', options%stretch, lower=1.0_wp, upper=largest_stretch)
    case ('TRANSFER')
      call read_transfer(cursor, options)
    case ('ACCEPT')
      call read_limits(cursor, options%accept)
    case ('TRIES')
      call cursor%integer('the number of other ways tried when a mesh is refused', options%tries, lower=0)
    case ('MESHER')
      call words_of(meshers, words)
      call cursor%name('who makes the mesh', words, options%mesher)
      if (options%mesher == by_gmsh .and. has_zones(options)) &
        call cursor%fail('ZONE cards and Gmsh exclude one another: leave out the one or the other')
      if (options%mesher == by_free .and. has_zones(options)) &
        call cursor%fail('ZONE cards and MESHER FREE exclude one another: leave out the one or the other')
    end select
  end subroutine read_remesher_row

  !> Limits of the restart by their words, each once.
  subroutine read_limits(cursor, accept)
    type(cursor_t), intent(inout) :: cursor
    type(acceptance_t), intent(inout) :: accept
    type(string_t), allocatable :: words(:)
    logical, allocatable :: given(:)
    integer :: k

    call words_of(limits, words)
    given = spread(.false., 1, size(words))
    do
      call cursor%name('one of '//limits, words, k)
      if (k == 0) return
      if (given(k)) call cursor%fail(words(k)%s//' is given twice')
      given(k) = .true.
      select case (words(k)%s)
      case ('RESIDUAL')
        call positive('the largest first residual, in the norm of energy', accept%first_residual)
        accept%residual_is_given = .true.
      case ('ITERATIONS')
        call cursor%integer('the largest number of iterations to equilibrium', accept%iterations, lower=1)
      case ('FORCE')
        call positive('the largest change of the force of a die', accept%force_change)
        accept%force_is_given = .true.
      case ('ENERGY')
        call positive('the largest change of the elastic energy', accept%energy_change)
      case ('DEPTH')
        call positive('the largest change of a depth over what contact and sides allow', accept%depth_change)
      case ('STEP')
        call cursor%real('the least step on the new mesh over the least before it', accept%step_ratio, lower=0.0_wp, upper=1.0_wp)
      end select
      if (.not. cursor%more()) exit
    end do

  contains

    subroutine positive(what, limit)
      character(len=*), intent(in) :: what
      real(wp), intent(inout) :: limit

      call cursor%real(what, limit, lower=0.0_wp, strict_lower=.true.)
    end subroutine positive

  end subroutine read_limits

  !> A method, and its number if it has one.
  subroutine read_transfer(cursor, options)
    type(cursor_t), intent(inout) :: cursor
    type(remesher_options_t), intent(inout) :: options
    type(string_t), allocatable :: words(:)
    integer :: k

    call words_of(methods, words)
    call cursor%name('a method of transfer', words, k)
    if (k == 0) return
    options%transfer = k - 1
    if (.not. cursor%more()) return
    select case (words(k)%s)
    case ('DIST')
      call cursor%real('N of 1/R^N', options%exponent, lower=0.0_wp, upper=20.0_wp, strict_lower=.true.)
    case ('MLS')
      call cursor%integer('the number of points', options%neighbours, lower=fewest_neighbours, upper=most_neighbours)
    end select
  end subroutine read_transfer

  !> New meshes of a run with so many times the deck's elements along a line: what the cards say of sizes, and of errors that
  !> fall with them, that of strains with the square of the size, that of the stress with the size at least (accuracy_laws). What
  !> they do not say follows the deck's own mesh, which is as much finer.
  pure subroutine make_sizes_finer(factor, rules, options)
    real(wp), intent(in) :: factor
    type(remesh_rules_t), intent(inout) :: rules
    type(remesher_options_t), intent(inout) :: options

    options%smallest = options%smallest/factor
    options%largest = options%largest/factor
    options%smallest_at_bends = options%smallest_at_bends/factor
    options%smallest_at_corners = options%smallest_at_corners/factor
    if (has_contours(options)) then
      options%contours%smallest = options%contours%smallest/factor
      options%contours%largest = options%contours%largest/factor
    end if
    options%most_elements = nint(options%most_elements*factor**2)
    options%windows%smallest = options%windows%smallest/factor
    options%windows%largest = options%windows%largest/factor
    options%strain_error = options%strain_error/factor**2
    options%across_contact = nint(options%across_contact*factor)
    options%turn = options%turn/factor
    options%turn_at_dies = options%turn_at_dies/factor
    if (rules%stress_error < never) rules%stress_error = rules%stress_error/factor
  end subroutine make_sizes_finer

end module remesher_rows

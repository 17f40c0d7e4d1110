!> Fields: the unknowns of a scene as declared data.
!>
!> A field is declared by the elements that have it among their unknowns: its name, unit, number of components, where its values
!> stand, what acts on it. The solution owns its values; equations are numbered for those that elements declare. Predictor, norms,
!> acceptance, history, files and remeshing are loops over fields.
module fields
  use kinds, only: wp
  use state_variables, only: transfer_recompute
  implicit none
  private
  public :: field_t, fill_middle_nodes, find_field, has_corners_only, load_factor_field, mechanical_fields, solved_with, &
            start_field
  public :: on_nodes, on_pilots, on_section
  public :: displacement_field, pilot_field, section_field, transfer_nodal

  !> Where the values of a field stand: on nodes of the mesh, on the pilots of the dies, on the section of the scene.
  integer, parameter :: on_nodes = 1, on_pilots = 2, on_section = 3
  !> Positions of the fields of mechanics in the list of a scene; others come after them.
  integer, parameter :: displacement_field = 1, pilot_field = 2, section_field = 3
  !> Carried over a remesh by the shape functions of the old mesh.
  character(len=*), parameter :: transfer_nodal = 'nodal'

  type :: field_t
    character(len=:), allocatable :: name
    !> Unit of a value, and of what acts on it (a force on a displacement, a heat flow on a temperature).
    character(len=:), allocatable :: unit, dual, dual_unit
    integer :: place = on_nodes
    !> Of a field on nodes: it has values of its own at the corners of 8-node elements only; in the middle of sides it is the mean
    !> of their ends.
    logical :: at_corners = .false.
    !> Components; from `first_angle` on they are angles (their duals are moments), 0 where none is.
    integer :: ncomp = 1, first_angle = 0
    !> Fields of one quantity share the norms of Newton's method: motion, temperature.
    character(len=:), allocatable :: quantity
    !> Supports and imposed motions give the value itself, not its change since the start.
    logical :: imposed_as_value = .false.
    !> How REMDATA carries it over (state_variables, or `nodal`).
    character(len=:), allocatable :: transfer
    !> Word for it on cards (FIXED, MOVE, FORCE, PROBE NODE, START); empty for those of mechanics.
    character(len=:), allocatable :: word
    !> Value at the start of the scene.
    real(wp) :: initial = 0.0_wp
    !> An element of the scene has it among its unknowns, or its values are given.
    logical :: declared = .false.
    !> Its values are given at all times (field_history_t of the scene): elements read it, none acts on it.
    logical :: given = .false.
    !> What acts on it and is below this is round-off (set at the first evaluation of a mesh).
    real(wp) :: floor = 0.0_wp
    !> Value at the accepted instant, its change in the last accepted step and in the one before, what acted from outside at that
    !> instant, and what supports and imposed values carried, without the loads on the same place (ncomp, place).
    real(wp), allocatable :: value(:, :), last_increment(:, :), older_increment(:, :), applied(:, :), reaction(:, :)
  end type field_t

contains

  !> Displacements of nodes, motions of pilots (x, y, angle) and of the section (sections).
  pure function mechanical_fields() result(list)
    type(field_t) :: list(3)

    list(displacement_field) = field_t(name='displacement', unit='length', dual='applied_force', dual_unit='force', &
                                       place=on_nodes, ncomp=2, quantity='motion', transfer=transfer_nodal, word='', &
                                       declared=.true.)
    list(pilot_field) = field_t(name='pilot', unit='length', dual='pilot_force', dual_unit='force', place=on_pilots, ncomp=3, &
                                first_angle=3, quantity='motion', transfer=transfer_recompute, word='', declared=.true.)
    list(section_field) = field_t(name='section', unit='length', dual='section_force', dual_unit='force', place=on_section, &
                                  ncomp=3, first_angle=2, quantity='motion', transfer=transfer_recompute, word='', &
                                  declared=.true.)
  end function mechanical_fields

  !> The value of a multiplier that is found, so that the motion follows what the deck gives.
  pure function load_factor_field() result(field)
    type(field_t) :: field

    field = field_t(name='load_factor', unit='-', dual='load_measure', dual_unit='-', place=on_section, ncomp=1, &
                    quantity='load', transfer=transfer_recompute, word='')
  end function load_factor_field

  !> The quantity whose solve finds a field: a load factor has norms of its own, and is found with the motion.
  pure function solved_with(field) result(quantity)
    type(field_t), intent(in) :: field
    character(len=:), allocatable :: quantity

    quantity = field%quantity
    if (quantity == 'load') quantity = 'motion'
  end function solved_with

  !> Position of a field in a list, 0 where it is not.
  pure function find_field(list, name) result(k)
    type(field_t), intent(in) :: list(:)   !! (nfield)
    character(len=*), intent(in) :: name
    integer :: k

    do k = 1, size(list)
      if (list(k)%name == name) return
    end do
    k = 0
  end function find_field

  !> Of 8-node elements it has unknowns on the first four nodes only.
  elemental function has_corners_only(field) result(yes)
    type(field_t), intent(in) :: field
    logical :: yes

    yes = field%place == on_nodes .and. field%at_corners
  end function has_corners_only

  !> Values of a field of so many places, all zero.
  pure subroutine start_field(nplace, field)
    integer, intent(in) :: nplace
    type(field_t), intent(inout) :: field

    allocate (field%value(field%ncomp, nplace), field%last_increment(field%ncomp, nplace), &
              field%older_increment(field%ncomp, nplace), field%applied(field%ncomp, nplace), &
              field%reaction(field%ncomp, nplace), source=0.0_wp)
    field%value = field%initial
  end subroutine start_field

  !> Values in the middle of the sides of 8-node elements, where a field has none of its own: the mean of the ends.
  pure subroutine fill_middle_nodes(connectivity, values)
    integer, intent(in) :: connectivity(:, :)   !! (8, nelem)
    real(wp), intent(inout) :: values(:, :)     !! (ncomp, nnode) [unit of the field]
    integer :: e, k

    do e = 1, size(connectivity, 2)
      do k = 1, 4
        values(:, connectivity(4 + k, e)) = 0.5_wp*(values(:, connectivity(k, e)) + values(:, connectivity(mod(k, 4) + 1, e)))
      end do
    end do
  end subroutine fill_middle_nodes

end module fields

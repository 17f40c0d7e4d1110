!> Measures the state transfer, for tests/bench/transfer_study.py: losses of transfers there and back, and seconds by size.
program transfer_bench
  use errors, only: error_t
  use kinds, only: wp
  use state_pieces, only: state_pieces_t
  use transfer_api, only: limit_material, limit_none, limit_sources, transfer_options_t, transfer_t
  use transfer_cases, only: carry_pieces
  use transfer_registry, only: list_transfers
  use transfer_report, only: transfer_report_t
  use transfer_study, only: field_edge, field_hill, loss_t, study_pieces, there_and_back
  implicit none
  character(len=4), parameter :: fields(3) = ['hill', 'band', 'edge']
  character(len=16) :: what

  call get_command_argument(1, what)
  select case (what)
  case ('losses')
    call print_losses()
  case ('neighbours')
    call print_neighbours()
  case ('seconds')
    call print_seconds()
  case default
    error stop 'transfer_bench losses | neighbours | seconds'
  end select

contains

  !> Rows of csv: one for each field, mesh, method with its options, and number of transfers.
  subroutine print_losses()
    integer, parameter :: transfers = 100, meshes(2) = [16, 32]
    character(len=8), parameter :: limits(0:2) = ['none    ', 'material', 'sources ']
    character(len=3), parameter :: answers(0:1) = ['no ', 'yes']
    type(transfer_options_t) :: options
    type(transfer_t), allocatable :: methods(:)
    type(loss_t) :: losses(transfers/2)
    type(error_t), allocatable :: error
    integer :: f, m, method, limit, degree, conserve, k

    call list_transfers(methods)
    print '(a)', 'field,elements,method,degree,limit,conserve,transfers,peak_loss,integral_change,rms_change,least'
    do f = field_hill, field_edge
      do m = 1, size(meshes)
        do method = 0, size(methods) - 1
          do degree = 1, 2
            if (method == 0 .and. degree == 1) cycle
            do limit = limit_none, limit_sources
              do conserve = 0, 1
                if (conserve == 1 .and. limit /= limit_material) cycle
                options%method = method
                options%degree = degree
                options%limit = limit
                options%conserve = conserve == 1
                call there_and_back(f, meshes(m), transfers, options, losses, error)
                if (allocated(error)) error stop 'transfer_bench: the transfer failed'
                do k = 1, size(losses)
                  print '(a,",",i0,4(",",a),",",i0,4(",",es13.5))', fields(f), meshes(m), methods(method + 1)%name, &
                    merge('-', achar(48 + degree), method == 0), trim(limits(limit)), trim(answers(conserve)), 2*k, &
                    losses(k)%peak, losses(k)%integral, losses(k)%change, losses(k)%least
                end do
              end do
            end do
          end do
        end do
      end do
    end do
  end subroutine print_losses

  !> Rows of csv: what 100 transfers by moving least squares over so many points change.
  subroutine print_neighbours()
    integer, parameter :: numbers(8) = [9, 10, 11, 12, 14, 16, 18, 20]
    type(transfer_options_t) :: options
    type(loss_t) :: losses(50)
    type(error_t), allocatable :: error
    integer :: k, f, n

    print '(a)', 'neighbours,field,elements,rms_change'
    options%conserve = .false.
    do k = 1, size(numbers)
      options%neighbours = numbers(k)
      do f = field_hill, field_edge
        do n = 16, 32, 16
          call there_and_back(f, n, 2*size(losses), options, losses, error)
          if (allocated(error)) error stop 'transfer_bench: the transfer failed'
          print '(i0,",",a,",",i0,",",es13.5)', numbers(k), fields(f), n, losses(size(losses))%change
        end do
      end do
    end do
  end subroutine print_neighbours

  !> Rows of csv: seconds of the processor (run it with one thread) for a whole transfer of one scalar, the least of three, by
  !> method and size.
  subroutine print_seconds()
    integer, parameter :: across(4) = [22, 71, 141, 224], again = 3
    type(transfer_options_t) :: options
    type(transfer_t), allocatable :: methods(:)
    type(state_pieces_t) :: old, new
    type(transfer_report_t) :: report
    type(error_t), allocatable :: error
    real(wp) :: start, finish, seconds
    integer :: m, method, k

    call list_transfers(methods)
    print '(a)', 'elements,method,seconds'
    do m = 1, size(across)
      call study_pieces(across(m), across(m), 0.12_wp, old)
      call study_pieces(across(m) + 1, across(m) - 1, 0.15_wp, new)
      do method = 0, size(methods) - 1
        options%method = method
        seconds = huge(seconds)
        do k = 1, again
          call cpu_time(start)
          call carry_pieces(old, new, options, report, error)
          call cpu_time(finish)
          if (allocated(error)) error stop 'transfer_bench: the transfer failed'
          seconds = min(seconds, finish - start)
        end do
        print '(i0,",",a,",",f0.4)', across(m)**2, methods(method + 1)%name, seconds
      end do
    end do
  end subroutine print_seconds

end program transfer_bench

!> System services that Fortran lacks, by one name: files and their paths, signals, the environment, this process.
!>
!> Thin bindings to the C library of a POSIX system, a module each.
module system
  use c_errors, only: last_failure, reason, text_of_c
  use environment, only: from_environment, in_environment, set_environment
  use file_paths, only: base_name, directory_of, join_path, path_beside, plain_path
  use file_system, only: directory_exists, file_exists, flush_to_disk, link_file, make_directory, remove_file, rename_file
  use signals, only: catch_signals, caught_signal, raise_termination, signals_to_errors
  use this_process, only: cpu_seconds, is_terminal, peak_memory_mb, program_stop, wall_seconds
  implicit none
  private
  public :: base_name, directory_of, join_path, path_beside, plain_path
  public :: catch_signals, caught_signal, raise_termination, signals_to_errors
  public :: cpu_seconds, is_terminal, peak_memory_mb, program_stop, wall_seconds
  public :: directory_exists, file_exists, flush_to_disk, link_file, make_directory, remove_file, rename_file
  public :: from_environment, in_environment, set_environment
  public :: last_failure, reason, text_of_c
end module system

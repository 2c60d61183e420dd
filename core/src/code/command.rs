//! Errors of the command line, of files that it writes, and of overact itself.

super::codes! {
    USAGE 601 "invalid arguments"
        cause "An option does not exist, lacks its value or excludes another one, or an output would overwrite an input of the command."
        cure "`overact COMMAND --help` lists all options; the message names the conflict."
    OUTPUT 602 "a file or folder that can't be written"
        cause "The parent folder does not exist, the file or folder is read-only, the disk is full, or a folder has the name of the file. Nothing was written: overact writes complete files or none."
        cure "Create the folder, choose another name, or change the permissions."
    FILE_EXISTS 603 "a file that exists already"
        cause "`new` does not overwrite files."
        cure "Choose another name, or remove the file first."
    STREAM 604 "standard input or output that fails"
        cause "Standard output can't be written, for instance because the disk is full, or standard input is not text."
        cure "Write to a file with -o, or give the input as a file."
    PUBLISHED 605 "published results that can't be read"
        cause "The file of --published has unknown keys, is invalid TOML, or has lists of another length than its `actuators`."
        cure "Give one number for each name in `actuators`; robots/README.md lists the keys."
    NOT_FRESH 606 "a generated file is out of date"
        cause "`generate --check` compares a file with what this version generates from the description. They differ, or the file is missing."
        cure "Run the command that the help names, and commit its output."
    MODULES_COLLIDE 607 "two robots or runs with one file or name"
        cause "Names of robots become names of modules and files, and names of runs become names of logs. Two of them are the same."
        cure "Rename one of them."
    NO_REDUNDANCY 608 "the robot has no choice of kept actuators"
        cause "`partitions` compares the choices of kept actuators. A robot with as many actuators as degrees of freedom has only one."
        cure "There is nothing to choose: use the platform projection (case 1)."
    NO_RESULT_TEXT 609 "a result that can't be written as text"
        cause "A table or document of results could not be formatted. This is not expected to happen."
        cure "Please report it with the description and the command."
}

mod internal {
    crate::code::codes! {
        INTERNAL 900 "an error of overact itself"
            cause "overact violated one of its internal rules. Your input is not the cause, and no output was left."
            cure "Please report it with the description, the command and the message."
    }
    pub(in crate::code) const OWN: &[crate::code::Explanation] = TABLE;
}
pub(super) const INTERNAL_TABLE: &[super::Explanation] = internal::OWN;

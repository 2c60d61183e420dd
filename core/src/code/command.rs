//! Errors of the command line, of files that it writes, and of overact itself.

super::codes! {
    USAGE 601 "arguments that do not go together"
        cause "An option does not exist, lacks its value, excludes another one, or an output would be written over something that the command reads."
        cure "`overact COMMAND --help` lists all options; the message says which two do not go together."
    OUTPUT 602 "a file or folder that can't be written"
        cause "Its folder does not exist, the file or folder is read-only, the disk is full, or a folder has the name of the file. Nothing was written: files are whole or not there."
        cure "Make the folder, choose another name, or change what may be written."
    FILE_EXISTS 603 "a file that is not overwritten"
        cause "`new` starts files and replaces none."
        cure "Choose another name, or remove the file first."
    STREAM 604 "standard input or output that fails"
        cause "Standard output takes no more, for instance because the disk behind it is full, or standard input is no text."
        cure "Write to a file with -o, or give the input as a file."
    PUBLISHED 605 "published results that can't be read"
        cause "The file of --published has unknown keys, is no TOML, or has lists of another length than its `actuators`."
        cure "Give one number for each name in `actuators`; robots/README.md lists the keys."
    NOT_FRESH 606 "a generated file is not what would be generated"
        cause "`generate --check` compares a file with what the description and this version give, and they differ, or the file is missing."
        cure "Run the command of the help, and commit what it writes."
    MODULES_COLLIDE 607 "two robots or runs would have one file or name"
        cause "Names of robots become names of modules and files, names of runs those of logs, and two of them become the same."
        cure "Rename one of them."
    NO_REDUNDANCY 608 "the robot has no choice of kept actuators"
        cause "`partitions` compares the choices of case 2, and a robot with as many actuators as degrees of freedom has none."
        cure "Nothing is to be chosen: case 1 is the only one."
    NO_RESULT_TEXT 609 "a result that can't be written as text"
        cause "A table or document of results could not be put into words; this is not expected to happen."
        cure "Please report it with the description and the command."
}

mod internal {
    crate::code::codes! {
        INTERNAL 900 "an error of overact itself"
            cause "Something inside overact broke one of its own rules. It is not your input that is wrong, and no output was left."
            cure "Please report it with the description, the command and the message."
    }
    pub(in crate::code) const OWN: &[crate::code::Explanation] = TABLE;
}
pub(super) const INTERNAL_TABLE: &[super::Explanation] = internal::OWN;

//! Errors in the structure of a description: names, legs, placements, platform, and broken files.

use super::{listed, rendered, single};

/// The errors of a robot whose root has these keys; they start at line 2.
fn root(keys: &str) -> Vec<String> {
    listed(&single(keys, ""))
}

#[test]
fn invalid_robot_and_constant_names_are_rejected() {
    let named = |name: &str| listed(&single("", "").replace("\"Arm\"", name)).concat();
    assert!(named("\"struct\"").starts_with("1:8 \"struct\" is a keyword of Rust"));
    assert!(named("\"self\"").starts_with("1:8 \"self\" is a keyword of Rust"));
    assert!(
        named("\"my robot\"").starts_with("1:8 \"my robot\" cannot be the name of a Rust type")
    );
    assert!(named("\"A{}; fn\"").starts_with("1:8 \"A{}; fn\" cannot be the name of a Rust type"));
    let constants = root("[constants]\ng = 1\nq_x = 2\nsin = 3\nb = \"c\"\nc = 2\nd = \"b\"");
    let expected = [
        "3:1 a constant cannot be named `g`",
        "4:1 a constant cannot be named `q_x`",
        "5:1 a constant cannot be named `sin`",
        // Dependents of a wrong constant are not reported.
        "6:6 unknown name `c`; known here: g, q_x, sin",
    ];
    assert_eq!(constants, expected);
}

#[test]
fn invalid_placements_are_rejected() {
    let text = r#"name = "A"
[leg.a]
variables = ["x", "x", "name"]
[[leg.a.joint]]
type = "revolut"
[leg.b]
joint = []
[leg.c]
[[place]]
name = "1leg"
shape = "d"
[[place]]
name = "l"
shape = "a"
y = 2
home = { 7 = 1 }
[[place]]
name = "l"
shape = "a"
x = 1
"#;
    let expected = [
        "3:19 a variable cannot be named `x`",
        "3:24 a variable cannot be named `name`",
        "5:8 `type`: expected one of \"revolute\", \"prismatic\", \"fixed\", \"cylindrical\", \"universal\", \"spherical\", \"planar\", \"helical\", found \"revolut\"; did you mean `revolute`?",
        "6:6 the leg `b` is never placed; a table [[place]] with name = \"leg1\" and shape = \"NAME\" places a leg",
        "7:9 a leg needs at least one joint",
        "8:1 the leg `c` has no `joint`; write its joints as [[leg.NAME.joint]], from the base on; a cable has type = \"cable\" instead",
        "8:6 the leg `c` is never placed; a table [[place]] with name = \"leg1\" and shape = \"NAME\" places a leg",
        "10:8 `1leg` cannot be the name of a leg; use letters, digits and underscores, a letter first",
        "11:9 there is no table [leg.d]; known: a, b, c",
        "12:1 a placement has no `x`; the leg `a` leaves this value to its placements",
        "15:1 unknown key `y`; known keys: name, shape, home, x",
        "16:10 unknown key `7`; known keys: 1",
        "17:1 a robot without platform has one leg without an end, and others only on bodies of chains; branches of a tree are joints whose `antecedent` is not the joint before them; those on a body of a chain are legs whose `base.body` names it",
        "18:8 there are two legs `l`",
    ];
    let found = listed(text);
    for line in expected {
        assert!(found.iter().any(|f| f == line), "{line}\nnot in {found:#?}");
    }
}

#[test]
fn missing_parts_are_reported() {
    let help = "write each leg once as [[leg.NAME.joint]] and place it by [[place]]";
    let expected = [
        "1:1 the description has no `name`; for instance name = \"MyRobot\"".to_owned(),
        format!("1:1 the description has no `leg`; {help}"),
    ];
    assert_eq!(listed(""), expected);
    assert_eq!(
        listed("name = 'A'\n[leg]\n"),
        [format!("2:1 the robot has no leg; {help}")]
    );
    let passive = single("", "").replace("actuated = true\n", "");
    assert_eq!(
        listed(&passive),
        ["3:1 no joint of the robot is actuated; mark a joint with actuated = true"]
    );
    assert!(
        listed("name = 'A'\nplace = []\n[[leg.a.joint]]\ntype = 'revolute'")
            .concat()
            .contains("never placed")
    );
}

#[test]
fn invalid_platforms_are_rejected() {
    let cases = [
        (
            "motion = \"planr\"",
            "3:10 `motion`: expected one of \"fixed axis\", \"point\", \"planar\"",
        ),
        (
            "",
            "2:1 the table `[platform]` has no `motion`; for instance motion = \"planar\"",
        ),
        (
            "motion = \"spatial\"\naxis = \"x\"",
            "4:8 `axis` has no meaning for this motion",
        ),
        (
            "motion = \"planar\"\naxis = \"w\"",
            "4:8 `axis`: expected one of \"x\", \"y\", \"z\", found \"w\"",
        ),
        (
            "motion = \"planar\"\nhome = { z = 0 }",
            "4:10 unknown key `z`; known keys: x, y, phi",
        ),
        (
            "motion = \"planar\"\nhome = { phi = \"1 m\" }",
            "4:16 `phi`: expected an angle (rad), found a length",
        ),
        (
            "motion = \"planar\"\nparameters = [\"ia\"]",
            "4:15 a free body has no parameter `ia`",
        ),
    ];
    for (keys, expected) in cases {
        let found = root(&format!("[platform]\n{keys}"));
        assert!(
            found.iter().any(|f| f.starts_with(expected)),
            "{expected}\nnot in {found:#?}"
        );
        assert!(
            found
                .iter()
                .any(|f| f.contains("the leg `arm` has no end on the platform"))
        );
    }
    let end = single("", "[leg.arm.end]\ntype = \"point\"\nrotation = [0, 0, 0]");
    let expected = [
        "6:1 the leg `arm` ends on a platform, but there is none; describe it in a table [platform], or a skeleton as a leg without `end`, whose bodies `end.body` names",
        "8:12 an end of type \"point\" has no rotation; leave it out, or use type = \"rigid\"",
    ];
    assert_eq!(listed(&end), expected);
}

#[test]
fn invalid_toml_is_located() {
    let found = listed("name = \"A\"\nb = = 2\n[c\n");
    // The unclosed table of the next line is not reported: it may be a consequence.
    assert_eq!(found.len(), 1, "{found:#?}");
    assert!(
        found[0].starts_with("2:5 this is not valid TOML: extra `=`"),
        "{found:#?}"
    );
}

/// A wrong expression in a leg is reported once, however often the leg is placed.
#[test]
fn errors_of_repeated_placements_are_reported_once() {
    let text = include_str!("../../../robots/dualv.toml").replace("d = \"l_ab\"", "d = \"turn\"");
    let found = listed(&text);
    assert_eq!(found.len(), 1, "{found:#?}");
    assert!(found[0].contains("`d`: expected a length (m), found an angle (180 deg)"));
}

/// Any damaged text gives a description or a list of errors.
#[test]
fn damaged_files_never_panic() {
    let whole = include_str!("../../../robots/dualv.toml");
    for end in (0..whole.len()).step_by(41) {
        let _ = rendered(whole.get(..end).unwrap_or_default());
    }
    let lines: Vec<&str> = whole.lines().collect();
    for skipped in 0..lines.len() {
        let rest: Vec<&str> = lines
            .iter()
            .enumerate()
            .filter(|(i, _)| *i != skipped)
            .map(|(_, l)| *l)
            .collect();
        let _ = rendered(&rest.join("\n"));
    }
}

/// The examples of the manual are valid, too.
#[test]
fn the_example_of_the_manual_is_valid() {
    let manual = include_str!("../../../robots/README.md");
    let example = manual
        .split("```toml")
        .nth(1)
        .and_then(|rest| rest.split("```").next());
    assert_eq!(listed(example.unwrap()), Vec::<String>::new());
}

/// `b_c` of `d` and `b` of `c_d` would share the names of their parameters.
#[test]
fn names_of_bodies_are_unique() {
    let text = r#"name = "A"
[platform]
motion = "fixed axis"
[[leg.a.joint]]
name = "b_c"
type = "prismatic"
actuated = true
[leg.a.end]
[[leg.b.joint]]
name = "b"
type = "prismatic"
[leg.b.end]
[[place]]
name = "d"
shape = "a"
[[place]]
name = "c_d"
shape = "b"
"#;
    let message = "another leg's joint is also called `b_c_d`; choose names without underscores";
    assert_eq!(
        listed(text),
        [format!("14:8 {message}"), format!("17:8 {message}")]
    );
}

/// A missing key is not reported in addition to the misspelt one.
#[test]
fn a_misspelt_required_key_is_one_error() {
    for (key, wrong) in [("type = ", "tpye = "), ("name = \"Arm\"", "nmae = \"Arm\"")] {
        let errors = listed(&single("", "").replacen(key, wrong, 1));
        assert_eq!(errors.len(), 1, "{errors:?}");
        let (wrong, key) = (&wrong[..4], &key[..4]);
        let expected = format!("unknown key `{wrong}`; did you mean `{key}`?");
        assert!(errors[0].contains(&expected), "{errors:?}");
    }
}

/// Errors that follow from a misspelt table are counted; others are listed.
#[test]
fn consequences_of_a_misspelt_table_are_not_listed() {
    let constants = "[constnts]\nl = \"1 m\"";
    let errors = listed(&single(constants, "d = \"l\""));
    assert_eq!(
        errors,
        [
            "2:2 unknown key `constnts`; did you mean `constants`? One further error may follow from it and is not listed."
        ]
    );
    let errors = listed(&single(constants, "d = \"l\"\nr = \"1 s\""));
    assert_eq!(errors.len(), 2, "{errors:?}");
    assert!(errors[1].contains("expected a length"), "{errors:?}");
}

//! Loops and joints of URDF extensions: Gazebo, YAML files of Pinocchio users, URDF+.

use overact_interchange::{Imported, Options, import};

/// Imports `robot.urdf`, with a YAML file next to it if `yaml` is not empty.
fn read(urdf: &str, yaml: &str, actuated: &str) -> Result<Imported, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("robot.urdf");
    std::fs::write(&file, urdf).expect("a file");
    if !yaml.is_empty() {
        std::fs::write(folder.path().join("robot.yaml"), yaml).expect("a file");
    }
    let names = actuated.split(',').map(str::to_owned).collect();
    let options = Options {
        actuated: (!actuated.is_empty()).then_some(names),
        ..Options::default()
    };
    import(&file, &options).map_err(|errors| {
        let all = errors.0.iter().flat_map(|(_, own)| own);
        all.map(|error| format!("{}\n", error.message)).collect()
    })
}

/// Legs of a description, without comments, experiment and parameters.
fn plain(found: Result<Imported, String>) -> String {
    let text = found.unwrap_or_else(|errors| panic!("{errors}")).text;
    let lines = text
        .lines()
        .take_while(|line| !line.starts_with("[identification]"));
    let lines = lines.filter(|line| !line.starts_with('#'));
    lines.map(|line| format!("{line}\n")).collect()
}

fn link(name: &str) -> String {
    format!(
        "<link name='{name}'><inertial><origin xyz='0.1 0 0'/><mass value='1'/>\
         <inertia ixx='0.01' iyy='0.02' izz='0.02'/></inertial></link>"
    )
}

fn joint(name: &str, ends: [&str; 2], kind: &str, more: &str) -> String {
    format!(
        "<joint name='{name}' type='{kind}'><parent link='{}'/><child link='{}'/><axis xyz='0 1 0'/>{more}</joint>",
        ends[0], ends[1]
    )
}

/// A parallelogram of links of 0.2 m and 0.5 m, open between `coupler` and `rocker`.
fn parallelogram(more: &str) -> String {
    let quarter = "rpy='0 -1.5707963267948966 0'";
    [
        "<robot name='loop'><link name='base'/>".to_owned(),
        link("crank") + &link("coupler") + &link("rocker"),
        joint(
            "a",
            ["base", "crank"],
            "continuous",
            &format!("<origin xyz='0 0 0' {quarter}/>"),
        ),
        joint(
            "b",
            ["crank", "coupler"],
            "continuous",
            "<origin xyz='0.2 0 0' rpy='0 1.5707963267948966 0'/>",
        ),
        joint(
            "c",
            ["base", "rocker"],
            "continuous",
            &format!("<origin xyz='0.5 0 0' {quarter}/>"),
        ),
        more.to_owned(),
        "</robot>".to_owned(),
    ]
    .concat()
}

#[test]
fn gazebo_joints_close_loops() {
    let gazebo = |kind: &str| {
        format!(
            "<gazebo><joint name='loop' type='{kind}'><parent>coupler</parent><child>rocker</child>\
             <pose>0.2 0 0 0 0 0</pose><axis><xyz>0 1 0</xyz></axis></joint></gazebo>"
        )
    };
    let ends = |kind: &str| {
        format!(
            "<loop name='loop' type='{kind}'><predecessor link='coupler'><origin xyz='0.5 0 0'/></predecessor>\
             <successor link='rocker'><origin xyz='0.2 0 0'/></successor><axis xyz='0 1 0'/></loop>"
        )
    };
    for kind in ["revolute", "ball"] {
        let found = plain(read(&parallelogram(&gazebo(kind)), "", "a"));
        assert_eq!(found, plain(read(&parallelogram(&ends(kind)), "", "a")));
    }
    let friction = gazebo("revolute").replace(
        "</xyz>",
        "</xyz><dynamics><damping>0.1</damping><friction>0</friction></dynamics>",
    );
    let found = read(&parallelogram(&friction), "", "a").expect("a loop");
    let reported = found.account.reported.iter().map(|own| own.subject());
    assert_eq!(reported.collect::<Vec<_>>(), ["damping"]);
    for (from, to, expected) in [
        (
            "<pose>",
            "<pose relative_to='coupler'>",
            "`relative_to` of <pose>",
        ),
        (
            "<xyz>",
            "<xyz expressed_in='base'>",
            "`expressed_in` of <xyz>",
        ),
        (
            "<parent>coupler",
            "<parent>couple",
            "there is no link or joint `couple`",
        ),
        ("0.2 0 0 0 0 0", "0.2 0", "<pose> must be 6 finite numbers"),
    ] {
        let text = parallelogram(&gazebo("revolute").replace(from, to));
        let message = read(&text, "", "a").expect_err("an error");
        assert!(message.starts_with(expected), "{message}");
    }
}

#[test]
fn drake_urdfdom_and_isaac_constraints_equal_loop_elements() {
    let ends = |kind: &str| {
        format!(
            "<loop name='k' type='{kind}'><predecessor link='coupler'><origin xyz='0.5 0 0'/></predecessor>\
             <successor link='rocker'><origin xyz='0.2 0 0'/></successor><axis xyz='0 1 0'/></loop>"
        )
    };
    let robot = |more: &str| {
        parallelogram(more).replace("<robot name='loop'", "<robot name='loop' xmlns:drake='d'")
    };
    let found = |more: &str, name: &str| plain(read(&robot(more), "", "a")).replace(name, "k");
    let point = "<drake:ball_constraint>\
        <drake:ball_constraint_body_A name='coupler'/><drake:ball_constraint_p_AP value='0.5 0 0'/>\
        <drake:ball_constraint_body_B name='rocker'/><drake:ball_constraint_p_BQ value='0.2 0 0'/>\
        </drake:ball_constraint>";
    assert_eq!(found(point, "ball_constraint"), found(&ends("ball"), "k"));
    for kind in ["ball", "revolute"] {
        let constraint = format!(
            "<constraint name='k' type='{kind}'><parent link='coupler'/><child link='rocker'/>\
             <parent_origin xyz='0.5 0 0'/><child_origin xyz='0.2 0 0'/><axis xyz='0 1 0'/></constraint>"
        );
        assert_eq!(found(&constraint, "k"), found(&ends(kind), "k"));
        let isaac = format!(
            "<loop_joint name='k' type='{kind}'><link1 link='coupler' xyz='0.5 0 0'/>\
             <link2 link='rocker' xyz='0.2 0 0'/><axis xyz='0 1 0'/></loop_joint>"
        );
        assert_eq!(found(&isaac, "k"), found(&ends(kind), "k"));
    }
    let nameless = point.replace("_body_B name='rocker'", "_body_B");
    assert!(read(&robot(&nameless), "", "a").is_err());
}

#[test]
fn yaml_closures_may_refer_to_fixed_joints() {
    let tip = |name: &str, of: &str, at: &str| {
        format!("<link name='{name}_link'/>")
            + &joint(
                name,
                [of, &format!("{name}_link")],
                "fixed",
                &format!("<origin xyz='{at}'/>"),
            )
    };
    let tips = tip("s", "coupler", "0.5 0 0") + &tip("t", "rocker", "0.2 0 0");
    let yaml = |ends: &str| format!("closed_loop: [[{ends}]]\ntype: ['3d']\nname_mot: ['a']\n");
    let by_joints = plain(read(&parallelogram(&tips), &yaml("s, t"), ""));
    let by_links = plain(read(&parallelogram(&tips), &yaml("s_link, t_link"), ""));
    // The joint of the closure is called after its ends.
    assert_eq!(by_joints, by_links.replace("s_link_and_t_link", "s_and_t"));
}

#[test]
fn yaml_lists_may_have_any_notation() {
    let tip = |name: &str, of: &str, at: &str| {
        format!("<link name='{name}'/>")
            + &joint(
                &format!("{name}_joint"),
                [of, name],
                "fixed",
                &format!("<origin xyz='{at}'/>"),
            )
    };
    let robot = parallelogram(&(tip("s", "coupler", "0.5 0 0") + &tip("t", "rocker", "0.2 0 0")));
    let expected = plain(read(
        &robot,
        "closed_loop: [[s, t]]\ntype: [3d]\nname_mot: [a]\n",
        "",
    ));
    for yaml in [
        "closed_loop:\n- - s\n  - t\ntype:\n- 3d\nname_mot:\n- a\n...\n",
        "closed_loop:\n  -\n    - s\n    - t\ntype: [3d]\nname_mot: [a]\n",
        "closed_loop:\n- [s, t]\ntype: [3d]\nname_mot: [a]\n",
        "\"closed_loop\": [['s', 't']]\n'type': [3d]\nname_mot: [a]\n",
    ] {
        assert_eq!(plain(read(&robot, yaml, "")), expected, "{yaml}");
    }
    for (yaml, message) in [
        (
            "closed_loop: s\nname_mot: [a]\n",
            "`closed_loop` is `s`, not a list of pairs of frames\n",
        ),
        (
            "closed_loop: [[s, t]]\ntype: [3d, 6d]\nname_mot: [a]\n",
            "`type` has 2 entries, but `closed_loop` 1\n",
        ),
    ] {
        assert_eq!(read(&robot, yaml, ""), Err(message.to_owned()), "{yaml}");
    }
}

#[test]
fn yaml_joints_may_be_universal_or_fixed() {
    let row = |middle: &str| {
        let text = "<robot name='row'><link name='base'/>".to_owned()
            + &link("a")
            + &link("b")
            + &link("c")
            + &joint(
                "j",
                ["base", "a"],
                "revolute",
                "<origin xyz='0.1 0 0.2' rpy='0.1 0.2 0.3'/>",
            )
            + middle
            + &joint("l", ["b", "c"], "revolute", "<origin xyz='0.4 0 0'/>");
        text + "</robot>"
    };
    let place = "<origin xyz='0.3 0 0.1' rpy='0.3 0.2 0.1'/>";
    let single = joint("k", ["a", "b"], "revolute", place);
    let x = "<axis xyz='1 0 0'/>";
    let both = "<link name='b_X'/>".to_owned()
        + &joint("k_X", ["a", "b_X"], "revolute", place).replace("<axis xyz='0 1 0'/>", x)
        + &joint("k_Y", ["b_X", "b"], "revolute", "");
    let kinds = |kind: &str| format!("joint_name: ['k']\njoint_type: ['{kind}']\n");
    let expected = plain(read(&row(&both), "", "j,k_X,k_Y,l"));
    for kind in ["CARDAN", "UJOINT_XY"] {
        assert_eq!(
            plain(read(&row(&single), &kinds(kind), "j,k_X,k_Y,l")),
            expected
        );
    }
    let z = "<axis xyz='0 0 1'/>";
    let both = "<link name='b_Z'/>".to_owned()
        + &joint("k_Z", ["a", "b_Z"], "revolute", place).replace("<axis xyz='0 1 0'/>", z)
        + &joint("k_X", ["b_Z", "b"], "revolute", "").replace("<axis xyz='0 1 0'/>", x);
    assert_eq!(
        plain(read(&row(&single), &kinds("UJOINT_ZX"), "j,k_Z,k_X,l")),
        plain(read(&row(&both), "", "j,k_Z,k_X,l"))
    );
    let fixed = joint("k", ["a", "b"], "fixed", place);
    assert_eq!(
        plain(read(&row(&single), &kinds("FIXED"), "j,l")),
        plain(read(&row(&fixed), "", "j,l"))
    );
    let message = read(&row(&single), &kinds("PLANAR"), "").expect_err("an error");
    assert!(
        message.starts_with("the joint `k` is `PLANAR`"),
        "{message}"
    );
}

/// Two arms of two joints each on one base.
fn arms(more: &str) -> String {
    let origin = "<origin xyz='0.3 0 0'/>";
    ["<robot name='arms'><link name='base'/>".to_owned()]
        .into_iter()
        .chain(["a", "b", "c"].map(link))
        .chain([
            joint("ja", ["base", "a"], "revolute", ""),
            joint("jb", ["a", "b"], "revolute", origin),
            joint("jc", ["b", "c"], "revolute", origin),
            more.to_owned(),
            "</robot>".to_owned(),
        ])
        .collect()
}

#[test]
fn urdf_plus_couplings_sum_joints_to_the_common_ancestor() {
    let coupling = |ends: [&str; 2]| {
        format!(
            "<coupling name='k'><predecessor link='{}'/><successor link='{}'/><ratio value='-2'/></coupling>",
            ends[0], ends[1]
        )
    };
    // `base` to `a` has the joint ja, and `a` is the ancestor of `b`: only jb is left.
    let message = read(&arms(&coupling(["a", "b"])), "", "").expect_err("an error");
    assert!(
        message.starts_with("the coupling is between 1 joints, not two: `jb`"),
        "{message}"
    );
    let tree = |follow: &str, more: &str| {
        let rotor = joint("jr", ["a", "r"], "revolute", follow);
        arms(&(link("r") + &rotor + more))
    };
    let expected = plain(read(
        &tree("<mimic joint='jb' multiplier='-2'/>", ""),
        "",
        "",
    ));
    assert_eq!(
        plain(read(&tree("", &coupling(["b", "r"])), "", "")),
        expected
    );
    // The tip is behind two joints.
    let message = read(&tree("", &coupling(["c", "r"])), "", "").expect_err("an error");
    assert!(
        message.starts_with("the coupling is between 3 joints, not two"),
        "{message}"
    );
    // A fixed link belongs to the joint before it.
    let tip = "<link name='tip'/>".to_owned() + &joint("f", ["b", "tip"], "fixed", "");
    let by_tip = tree("", &(tip.clone() + &coupling(["tip", "r"])));
    let expected = plain(read(
        &tree("<mimic joint='jb' multiplier='-2'/>", &tip),
        "",
        "",
    ));
    assert_eq!(plain(read(&by_tip, "", "")), expected);
}

/// A five-bar in the xy plane whose last elbow is a universal joint without a rotation in the plane.
///
/// Its first rotation, by a quarter turn, brings the second into the plane.
#[test]
fn the_home_is_moved_if_a_universal_joint_blocks_a_motor() {
    let pin = |name: &str, ends: [&str; 2], at: &str, turn: f64| {
        let origin = format!("<origin xyz='{at}' rpy='0 0 {turn}'/>");
        let limits = "<limit lower='-3' upper='3' effort='1' velocity='1'/>";
        joint(name, ends, "revolute", &(origin + limits)).replace("0 1 0", "0 0 1")
    };
    let tip = |name: &str, parent: &str| {
        let origin = "<origin xyz='0.3 0 0'/>";
        format!("<link name='{name}'/>") + &joint(name, [parent, name], "fixed", origin)
    };
    let urdf = "<robot name='five_bar'><link name='base'/>".to_owned()
        + &["a1", "a2", "b1", "b2"].map(link).concat()
        + &pin("a", ["base", "a1"], "0 0 0", 1.745_329_251_994_329_5)
        + &pin("a_", ["a1", "a2"], "0.25 0 0", -1.121_030_949_964_204_4)
        + &pin("b", ["base", "b1"], "0.4 0 0", 1.396_263_401_595_463_6)
        + &pin("b_", ["b1", "b2"], "0.25 0 0", 1.121_030_949_964_204_6)
        + &tip("tip_a", "a2")
        + &tip("tip_b", "b2")
        + "</robot>";
    let yaml = "closed_loop: [['tip_a', 'tip_b']]\ntype: ['3d']\nname_mot: ['a', 'b']\n\
                joint_name: ['b_']\njoint_type: ['UJOINT_XY']\n";
    let text = read(&urdf, yaml, "").expect("a five-bar").text;
    assert!(text.contains("Home is moved"), "{text}");
    let source = overact_codegen::Source::new("made.toml", text.clone());
    let checked = match overact_codegen::check(&source) {
        Ok(checked) => checked.mechanism,
        Err(errors) => panic!("{}\n{text}", errors.render_plain(&source)),
    };
    assert_eq!((checked.dof(), checked.actuated().len()), (2, 2));
}
